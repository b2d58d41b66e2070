/** Asks before a place goes, and names the programs and runs that go there. */
import { Button, Modal } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useChangePlace } from "@/api/places";
import { useOpenRuns, usePrograms } from "@/api/queries";
import type { MapPlace, RunSummary } from "@/api/types";
import { useReturnFocus } from "@/design/useReturnFocus";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import { useFreshUses } from "../useFreshUses";
import { isGone } from "../useRemovedMeanwhile";
import { begun, planned } from "../zones/uses";
import styles from "./places.module.css";

/** The programs of a site that name the place; null until that is known. */
export function usePlaceUses(slug: string, place: string) {
  return usePrograms(slug).data?.filter((program) => program.places.includes(place)) ?? null;
}

export function PlaceUses({ slug, place }: { slug: string; place: string }) {
  const { t } = useTranslation();
  useFreshUses(slug);
  const uses = usePlaceUses(slug, place);
  const runs = begun(useOpenRuns(slug).data ?? [], uses ?? []);
  if (uses === null) return null;
  if (uses.length === 0) return <p className={styles.quiet}>{t("place.unused")}</p>;
  return (
    <div>
      <p className={styles.quiet}>{t("place.usedBy", { count: uses.length })}</p>
      <ul className={styles.uses}>
        {uses.map((program) => (
          <li key={program.id}>
            <Link to={`/programs/${program.id}`}>{program.name}</Link>
          </li>
        ))}
      </ul>
      <RunList words={t("place.runs", { count: runs.length })} runs={runs} />
    </div>
  );
}

function RunList({ words, runs }: { words: string; runs: readonly RunSummary[] }) {
  const { t } = useTranslation();
  if (runs.length === 0) return null;
  return (
    <div role="note">
      <p className={styles.quiet}>{words}</p>
      <ul className={styles.uses}>
        {runs.map((run) => (
          <li key={run.id}>
            <Link to={`/runs/${run.id}`}>{t("place.run", { number: run.number, name: run.program.name })}</Link>
          </li>
        ))}
      </ul>
    </div>
  );
}

interface RemovePlaceProps {
  slug: string;
  place: MapPlace;
  /** Choose another place to edit, or none. */
  select: (place: string | null) => void;
  onClose: () => void;
}

export function RemovePlace({ slug, place, select, onClose }: RemovePlaceProps) {
  const { t } = useTranslation();
  useReturnFocus();
  const tellUnseen = useTellUnseen();
  const change = useChangePlace(slug, (error) => isGone(error) || tellUnseen(error));
  const uses = usePlaceUses(slug, place.id);
  const later = planned(useOpenRuns(slug).data ?? [], uses ?? []);
  const remove = () => {
    select(null);
    const onError = (error: Error) => (isGone(error) ? onClose() : select(place.id));
    change.mutate({ do: "remove", id: place.id }, { onSuccess: onClose, onError });
  };
  return (
    <Modal opened onClose={onClose} title={t("place.removeAsk", { name: place.name })} size={440}>
      <div className={styles.form}>
        <PlaceUses slug={slug} place={place.id} />
        {uses && uses.length > 0 ? <p>{t("place.removeText", { count: uses.length })}</p> : null}
        <RunList words={t("place.planned", { count: later.length })} runs={later} />
        {change.error ? <p role="alert">{problemText(change.error, t("shell.problem.screen"))}</p> : null}
        <div className={styles.decide}>
          <Button variant="default" onClick={onClose} data-autofocus>
            {t("keys.cancel")}
          </Button>
          <Button color="red" loading={change.isPending} onClick={remove}>
            {t("place.remove")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}
