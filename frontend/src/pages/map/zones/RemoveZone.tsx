/** Asks before a zone goes, and names whom it concerns. */
import { Button, Modal } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices, useOpenRuns, usePrograms } from "@/api/queries";
import type { MapZone, SiteMap } from "@/api/types";
import { useChangeZone } from "@/api/zones";
import { useReturnFocus } from "@/design/useReturnFocus";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import styles from "../places/places.module.css";
import { useFreshUses } from "../useFreshUses";
import { isGone } from "../useRemovedMeanwhile";
import { usesOf } from "./uses";

interface ZoneUsesProps {
  slug: string;
  map: SiteMap;
  zone: MapZone;
}

export function ZoneUses({ slug, map, zone }: ZoneUsesProps) {
  const { t } = useTranslation();
  useFreshUses(slug);
  const [devices, programs, runs] = [useDevices(slug).data, usePrograms(slug).data, useOpenRuns(slug).data];
  if (!devices || !programs || !runs) return null;
  const uses = usesOf(zone, { places: map.places, devices, programs, runs });
  const inside = [...uses.places, ...uses.machines].map(({ name }) => name);
  return (
    <div className={styles.adding}>
      <p className={styles.quiet}>
        {inside.length > 0 ? t("zone.inside", { names: inside.join(", ") }) : t("zone.nothingInside")}
      </p>
      {uses.programs.length > 0 ? (
        <div>
          <p className={styles.quiet}>{t("zone.usedBy", { count: uses.programs.length })}</p>
          <ul className={styles.uses}>
            {uses.programs.map((program) => (
              <li key={program.id}>
                <Link to={`/programs/${program.id}`}>{program.name}</Link>
              </li>
            ))}
          </ul>
        </div>
      ) : null}
      {uses.runs.length > 0 ? (
        <div>
          <p className={styles.quiet}>{t("zone.runs", { count: uses.runs.length })}</p>
          <ul className={styles.uses}>
            {uses.runs.map((run) => (
              <li key={run.id}>
                <Link to={`/runs/${run.id}`}>{t("zone.run", { number: run.number, name: run.program.name })}</Link>
              </li>
            ))}
          </ul>
        </div>
      ) : null}
    </div>
  );
}

interface RemoveZoneProps extends ZoneUsesProps {
  /** Choose another zone to edit, or none. */
  select: (zone: string | null) => void;
  onClose: () => void;
}

export function RemoveZone({ slug, map, zone, select, onClose }: RemoveZoneProps) {
  const { t } = useTranslation();
  useReturnFocus();
  const tellUnseen = useTellUnseen();
  const change = useChangeZone(slug, (error) => isGone(error) || tellUnseen(error));
  const remove = () => {
    select(null);
    const onError = (error: Error) => (isGone(error) ? onClose() : select(zone.id));
    change.mutate({ do: "remove", id: zone.id }, { onSuccess: onClose, onError });
  };
  return (
    <Modal opened onClose={onClose} title={t("zone.removeAsk", { name: zone.name })} size={440}>
      <div className={styles.form}>
        <p>{t("zone.removeText")}</p>
        <ZoneUses slug={slug} map={map} zone={zone} />
        {change.error ? <p role="alert">{problemText(change.error, t("shell.problem.screen"))}</p> : null}
        <div className={styles.decide}>
          <Button variant="default" onClick={onClose} data-autofocus>
            {t("keys.cancel")}
          </Button>
          <Button color="red" loading={change.isPending} onClick={remove}>
            {t("zone.remove")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}
