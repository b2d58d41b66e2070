/** In the place of a recording that is not there yet, or never will be: why, how far it is, and what can be done. */
import { Button } from "@mantine/core";
import { X } from "lucide-react";
import { useTranslation } from "react-i18next";
import { ApiProblem } from "@/api/client";
import { mayOperate } from "@/api/roles";
import type { Program, Rehearsal, Site } from "@/api/types";
import { reasonWords } from "@/i18n/reasons";
import { isOver } from "@/live/messages";
import { useCancelRehearsal } from "../useRehearsals";
import { OpenRehearsals } from "./OpenRehearsals";
import { progressWords } from "./progress";
import screen from "../SimulationScreen.module.css";
import styles from "./waiting.module.css";

interface WaitingPaneProps {
  rehearsal?: Rehearsal;
  /** It is not known yet how the rehearsal stands. */
  loading: boolean;
  /** Why it could not be started or fetched. */
  refusal?: string;
  site?: Site;
  program?: Program;
  onAgain: () => void;
}

export function WaitingPane({ rehearsal, loading, refusal, site, program, onAgain }: WaitingPaneProps) {
  const { t } = useTranslation();
  const shown = refusal === undefined ? rehearsal : undefined;
  const over = refusal !== undefined || (rehearsal ? isOver(rehearsal.status) : !loading);
  return (
    <section className={`${screen.pane} ${screen.waiting}`}>
      <div role="status">
        <h2>{t(titleOf(shown, refusal, loading))}</h2>
      </div>
      {refusal === undefined ? null : <p role="alert">{refusal}</p>}
      {shown ? <Standing rehearsal={shown} site={site} /> : null}
      {over && mayOperate(site?.role) ? (
        <Button onClick={onAgain}>{t(rehearsal ? "simulation.again" : "simulation.start")}</Button>
      ) : null}
      {(over || rehearsal?.status === "queued") && site && program ? (
        <OpenRehearsals site={site} except={rehearsal?.id} />
      ) : null}
    </section>
  );
}

function titleOf(rehearsal: Rehearsal | undefined, refusal: string | undefined, loading: boolean): string {
  if (refusal !== undefined) return "simulation.queue.refusedTitle";
  if (!rehearsal) return loading ? "simulation.loading" : "simulation.noRehearsal";
  if (rehearsal.status === "queued") return "simulation.queue.title";
  if (rehearsal.status === "cancelled") return "simulation.queue.cancelledTitle";
  return rehearsal.status === "failed" ? "simulation.failedTitle" : "simulation.running";
}

/** How the rehearsal stands, and its end where the asker may bring it about. */
function Standing({ rehearsal, site }: { rehearsal: Rehearsal; site?: Site }) {
  const { t } = useTranslation();
  if (isOver(rehearsal.status))
    return rehearsal.reason ? <p role="alert">{reasonWords(rehearsal.cause, rehearsal.reason)}</p> : null;
  return (
    <>
      <progress
        className={screen.progress}
        max={1}
        value={rehearsal.progress}
        aria-label={t(rehearsal.status === "queued" ? "simulation.queue.title" : "simulation.running")}
      />
      {rehearsal.status === "queued" ? <Place place={rehearsal.place ?? 1} /> : <Course rehearsal={rehearsal} />}
      {rehearsal.tries > 1 ? <p>{t("simulation.queue.anew")}</p> : null}
      <p>{t("simulation.runningHint")}</p>
      <CancelOwn rehearsal={rehearsal} site={site} />
    </>
  );
}

function Place({ place }: { place: number }) {
  const { t } = useTranslation();
  return (
    <p className={styles.place} aria-live="polite">
      {place === 1 ? t("simulation.queue.next") : t("simulation.queue.before", { count: place - 1 })}
    </p>
  );
}

function Course({ rehearsal }: { rehearsal: Rehearsal }) {
  const { t } = useTranslation();
  const { course, compiled } = rehearsal;
  if (!course) return null;
  return (
    <>
      <p className={styles.figures}>{progressWords(course, compiled.numbers)}</p>
      {course.end_known ? null : <p>{t("simulation.queue.endUnknown")}</p>}
    </>
  );
}

function CancelOwn({ rehearsal, site }: { rehearsal: Rehearsal; site?: Site }) {
  const { t } = useTranslation();
  const cancel = useCancelRehearsal(site?.slug);
  if (!rehearsal.mine && !mayOperate(site?.role)) return null;
  return (
    <>
      <Button
        variant="default"
        leftSection={<X size={16} aria-hidden="true" />}
        loading={cancel.isPending}
        onClick={() => cancel.mutate(rehearsal.id)}
      >
        {t("simulation.queue.cancel")}
      </Button>
      {cancel.error instanceof ApiProblem ? <p role="alert">{cancel.error.detail}</p> : null}
    </>
  );
}
