import { useTranslation } from "react-i18next";
import type { RunSummary } from "@/api/types";
import { Chip } from "@/design/Chip";
import { formatMoment } from "@/i18n/format";
import { isLate, isPlanned } from "./terms";

/** What is not usual about a run: its priority, the time it waits for, its deadline, what let it start. */
export function RunTerms({ run, now }: { run: RunSummary; now: number }) {
  const { t } = useTranslation();
  const late = isLate(run, now);
  return (
    <>
      {run.priority === "normal" ? null : (
        <Chip tone={run.priority === "high" ? "brand" : "quiet"}>{t(`run.terms.${run.priority}`)}</Chip>
      )}
      {run.not_before && isPlanned(run, now) ? (
        <Chip tone="pend">{t("run.terms.begins", { at: formatMoment(run.not_before) })}</Chip>
      ) : null}
      {run.deadline ? (
        <Chip tone={late ? "warn" : "quiet"}>
          {t(late ? "run.terms.late" : "run.terms.due", { at: formatMoment(run.deadline) })}
        </Chip>
      ) : null}
      {run.permit && !run.permit.emergency ? (
        <Chip tone="done">{t("review.run.approved", { people: run.permit.approved_by.join(", ") })}</Chip>
      ) : null}
    </>
  );
}
