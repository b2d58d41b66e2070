/** VIPO's processes: who beats, who is silent, and whose clock is off. */
import { useTranslation } from "react-i18next";
import type { VipoProcess } from "@/api/types";
import { StatusBadge } from "@/design/StatusBadge";
import type { StatusName } from "@/design/StatusGlyph";
import { useNow } from "@/design/useNow";
import { formatAgo, formatMoment, formatNumber, formatSpan, withUnit } from "@/i18n/format";
import pages from "../pages.module.css";
import { TableSection } from "../section/Section";
import styles from "./operations.module.css";

const COLUMNS = ["process", "state", "activity", "beat", "clock", "since", "version"];
const OPTIONAL = ["since", "version"];
const SIGNS: Record<VipoProcess["state"], StatusName> = { beats: "done", silent: "error", ended: "offline" };
/** As in registry/processes/findings.py. */
const APART_S = 2;
/** Less than this is not worth a figure. */
const RIGHT_S = 0.5;

function Clock({ apart }: { apart: number | null }) {
  const { t } = useTranslation();
  if (apart === null) return <span className={pages.none}>{t("operations.clockUnknown")}</span>;
  if (Math.abs(apart) < RIGHT_S) return t("operations.clockRight");
  const seconds = withUnit(formatNumber(Math.abs(apart), 1), "s");
  const words = t(apart > 0 ? "operations.clockAhead" : "operations.clockBehind", { seconds });
  return Math.abs(apart) > APART_S ? <StatusBadge status="error">{words}</StatusBadge> : words;
}

function Row({ process, now }: { process: VipoProcess; now: number }) {
  const { t } = useTranslation();
  return (
    <tr>
      <td className={pages.name}>
        <span className={pages.strong}>{t(`operations.kind.${process.kind}`)}</span>
        <small className={styles.who} title={`${process.name}, ${process.machine}, ${process.process}`}>
          {process.name} · {process.process}
        </small>
      </td>
      <td className={pages.nowrap}>
        <StatusBadge status={SIGNS[process.state]}>{t(`operations.state.${process.state}`)}</StatusBadge>
      </td>
      <td>{process.state === "beats" ? t(`operations.activity.${process.activity || "none"}`) : "–"}</td>
      <td className={pages.nowrap}>{t("operations.ago", { ago: formatSpan(process.age_s) })}</td>
      <td className={pages.nowrap}>
        <Clock apart={process.state === "beats" ? process.clock_apart_s : null} />
      </td>
      <td className={`${pages.nowrap} ${pages.optional}`} title={formatMoment(process.since)}>
        {formatAgo(process.since, now)}
      </td>
      <td className={`${pages.nowrap} ${pages.optional}`}>{process.version}</td>
    </tr>
  );
}

export function ProcessTable({ processes }: { processes: readonly VipoProcess[] }) {
  const { t } = useTranslation();
  const now = useNow(15_000);
  return (
    <TableSection
      catalogue="operations"
      title={t("operations.processes")}
      count={processes.length}
      columns={COLUMNS}
      optional={OPTIONAL}
    >
      {processes.map((process) => (
        <Row key={process.id} process={process} now={now} />
      ))}
    </TableSection>
  );
}
