import { useTranslation } from "react-i18next";
import type { MethodCall } from "@/api/types";
import { StatusBadge } from "@/design/StatusBadge";
import type { StatusName } from "@/design/StatusGlyph";
import { formatSpan } from "@/i18n/format";
import { reasonWords } from "@/i18n/reasons";
import { useNow } from "@/design/useNow";
import styles from "./call.module.css";

const SIGNS: Readonly<Record<MethodCall["status"], StatusName>> = {
  pending: "waiting",
  sent: "waiting",
  accepted: "waiting",
  running: "busy",
  done: "done",
  failed: "error",
  rejected: "error",
  cancelled: "warning",
  timed_out: "error",
};

/** How far a call has come, what it gave, or why it was not done. */
export function CallProgress({ call }: { call: MethodCall }) {
  const { t } = useTranslation();
  const now = useNow(500);
  const end = call.ended_at ? Date.parse(call.ended_at) : now;
  const seconds = Math.max(0, (end - Date.parse(call.created_at)) / 1000);
  const results = Object.entries(call.result);
  return (
    <section className={styles.progress} aria-live="polite" aria-label={t("device.try.progress")}>
      <p className={styles.outcome}>
        <StatusBadge status={SIGNS[call.status]}>{t(`device.try.status.${call.status}`)}</StatusBadge>
        <span aria-hidden={!call.over}>{formatSpan(seconds)}</span>
      </p>
      {call.why ? <p>{reasonWords(call.cause, call.why)}</p> : null}
      {results.length > 0 ? (
        <dl className={styles.result}>
          {results.map(([name, value]) => (
            <div key={name}>
              <dt>{name}</dt>
              <dd>{String(value)}</dd>
            </div>
          ))}
        </dl>
      ) : null}
    </section>
  );
}
