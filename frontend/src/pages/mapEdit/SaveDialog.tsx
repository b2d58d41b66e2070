/** Before a changed or brought map is saved: what it changes, and which machines, places and programs it troubles. */
import { Button, Modal, Skeleton } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { TriangleAlert } from "lucide-react";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { ApiProblem } from "@/api/client";
import { useBringMap, useLookAtMap, type BroughtMapDifference, type MapSource } from "@/api/siteMaps";
import type { SiteMap } from "@/api/types";
import { isSameMap } from "@/api/wholeMap";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatNumber, withUnit } from "@/i18n/format";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import styles from "./mapEdit.module.css";

const AMOUNTS = [
  ["wallsGained", "walls_gained_m2"],
  ["wallsLost", "walls_lost_m2"],
  ["floorGained", "floor_gained_m2"],
  ["floorLost", "floor_lost_m2"],
] as const;

type MapName = Pick<SiteMap, "version" | "tag">;

interface SaveProps {
  slug: string;
  title: string;
  /** What saving is called while nobody has saved another one. */
  action: string;
  /** The map as the server takes it; made once. */
  makeForm: () => FormData;
  source: MapSource;
  /** The map that was changed, and the one that the site has by now. */
  base: MapName;
  newest: MapName;
  /** It is saved and told; not called once this dialog is gone. */
  onSaved: () => void;
  onClose: () => void;
}

export function SaveDialog({ slug, title, action, makeForm, source, base, newest, onSaved, onClose }: SaveProps) {
  const { t } = useTranslation();
  useReturnFocus();
  const { mutate: lookAt, ...look } = useLookAtMap(slug);
  const bring = useBringMap(slug);
  const [form] = useState(makeForm);
  useEffect(() => lookAt(form), [lookAt, form]);
  const isOvertaken = !isSameMap(newest, base) || (bring.error instanceof ApiProblem && bring.error.status === 412);
  const tellUnseen = useTellUnseen();
  /** What comes of it is told also to who has left the page before the answer. */
  const save = () =>
    bring
      .mutateAsync({ form, source, replaces: newest.tag }, { onSuccess: onSaved })
      .then(({ version }) => notifications.show({ message: t("mapEdit.saved", { version }) }), tellUnseen);
  const problem = look.error ?? (isOvertaken ? null : bring.error);
  return (
    // Behind it the map could be drawn on while it is being saved: so it stays until the answer.
    <Modal
      opened
      onClose={onClose}
      closeOnEscape={!bring.isPending}
      withCloseButton={!bring.isPending}
      title={title}
      size={560}
    >
      <div className={styles.dialog}>
        {look.data ? <Difference slug={slug} difference={look.data} /> : null}
        {look.isPending ? <Skeleton height={120} radius="md" /> : null}
        {isOvertaken ? (
          <p role="alert" className={styles.overtaken}>
            <TriangleAlert size={16} aria-hidden="true" /> {t("mapEdit.overtaken", { version: newest.version })}
          </p>
        ) : null}
        {problem ? (
          <p role="alert" className={styles.problem}>
            {problemText(problem, t("shell.problem.screen"))}
          </p>
        ) : null}
        <p className={styles.quiet}>{t("mapEdit.kept")}</p>
        <div className={styles.decide}>
          <Button variant="default" disabled={bring.isPending} onClick={onClose} data-autofocus>
            {t("keys.cancel")}
          </Button>
          <Button loading={bring.isPending} disabled={!look.data} onClick={() => void save()}>
            {isOvertaken ? t("mapEdit.saveOver") : action}
          </Button>
        </div>
      </div>
    </Modal>
  );
}

function Difference({ slug, difference }: { slug: string; difference: BroughtMapDifference }) {
  const { t } = useTranslation();
  const troubles = difference.troubles.filter((trouble) => trouble.is_new);
  const isFine = troubles.length + difference.programs.length === 0;
  return (
    <>
      <dl className={styles.amounts}>
        {AMOUNTS.map(([name, field]) => (
          <div key={name}>
            <dt>{t(`robotMap.change.${name}`)}</dt>
            <dd>{withUnit(formatNumber(difference[field], 1), "m²")}</dd>
          </div>
        ))}
      </dl>
      {isFine ? <p>{t("mapEdit.fine")}</p> : <h3 className={styles.warn}>{t("mapEdit.troubled")}</h3>}
      <ul className={styles.troubles}>
        {troubles.map((trouble) => (
          <li key={`${trouble.kind} ${trouble.id}`}>
            <b>{trouble.name}</b> {t(`robotMap.trouble.${trouble.kind}.${trouble.why}`)}
          </li>
        ))}
        {difference.programs.map((program) => (
          <li key={program.id}>
            <Link to={`/programs/${program.id}`} target="_blank">
              {program.name}
            </Link>{" "}
            {program.steps_outside ? t("mapEdit.stepsOutside", { count: program.steps_outside }) : null}{" "}
            {program.points_walled ? t("mapEdit.pointsWalled", { count: program.points_walled }) : null}
          </li>
        ))}
      </ul>
      {isFine ? null : (
        <Link to={`/sites/${slug}/programs`} target="_blank" className={styles.quiet}>
          {t("mapEdit.programs")}
        </Link>
      )}
    </>
  );
}
