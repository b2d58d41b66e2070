/** What takes how many bytes, by program, and which files the archive has. */
import { useTranslation } from "react-i18next";
import type { Retention } from "@/api/types";
import { formatBytes, formatMoment, formatNumber } from "@/i18n/format";
import pages from "../pages.module.css";
import { TableSection } from "../section/Section";
import styles from "./retention.module.css";

const PARTS = ["runs", "journals", "commands", "rehearsals", "archived"] as const;
const FILES = ["kind", "ended", "count", "size", "made", "file"];

const bytes = (size: number) => (size === 0 ? "–" : formatBytes(size));

export function ProgramTable({ retention }: { retention: Retention }) {
  const { t } = useTranslation();
  const rows = retention.programs.map((each) => (
    <tr key={each.program}>
      <td className={pages.strong}>{each.name}</td>
      {PARTS.map((part) => (
        <td key={part} className={pages.nowrap}>
          {bytes(each[part])}
        </td>
      ))}
    </tr>
  ));
  const calls = (
    <tr key="calls">
      <td>{t("retention.callsRow")}</td>
      <td>–</td>
      <td>–</td>
      <td className={pages.nowrap}>{bytes(retention.calls)}</td>
      <td>–</td>
      <td className={pages.nowrap}>{bytes(retention.calls_archived)}</td>
    </tr>
  );
  return (
    <TableSection
      catalogue="retention"
      title={t("retention.programs")}
      columns={["program", ...PARTS]}
      empty={t("retention.noPrograms")}
    >
      {retention.calls + retention.calls_archived > 0 ? [...rows, calls] : rows}
    </TableSection>
  );
}

export function ArchiveTable({ retention }: { retention: Retention }) {
  const { t } = useTranslation();
  const { archives, archive_bytes: size, archive_count: count } = retention;
  const remark = count > 0 ? t("retention.total", { bytes: formatBytes(size), count }) : undefined;
  return (
    <TableSection
      catalogue="retention"
      title={t("retention.archives")}
      remark={remark}
      columns={FILES}
      empty={t("retention.noArchives")}
    >
      {archives.map((each) => (
        <tr key={each.id}>
          <td className={pages.strong}>{t(`retention.kind.${each.kind}`)}</td>
          <td className={pages.nowrap}>{formatMoment(each.last_at)}</td>
          <td>{formatNumber(each.count)}</td>
          <td className={pages.nowrap}>{formatBytes(each.bytes)}</td>
          <td className={pages.nowrap}>{formatMoment(each.made_at)}</td>
          <td className={styles.file}>
            <code>{each.file}</code>
          </td>
        </tr>
      ))}
    </TableSection>
  );
}
