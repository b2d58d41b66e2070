/** What takes how many bytes, by program, and which files the archive has. */
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import type { Retention } from "@/api/types";
import { Panel } from "@/design/Panel";
import { formatBytes, formatMoment, formatNumber } from "@/i18n/format";
import pages from "../pages.module.css";
import styles from "./retention.module.css";

const PARTS = ["runs", "journals", "commands", "rehearsals", "archived"] as const;
const FILES = ["kind", "ended", "count", "size", "made", "file"];

interface TableProps {
  title: string;
  remark?: string;
  columns: readonly string[];
  empty: string;
  children: ReactNode[];
}

function Table({ title, remark, columns, empty, children }: TableProps) {
  const { t } = useTranslation();
  return (
    <Panel className={styles.section} aria-label={title}>
      <div className={styles.head}>
        <h2>{title}</h2>
        {remark ? <span>{remark}</span> : null}
      </div>
      {children.length === 0 ? (
        <p className={styles.empty}>{empty}</p>
      ) : (
        <div className={pages.scroll}>
          <table className={pages.table}>
            <thead>
              <tr>
                {columns.map((column) => (
                  <th key={column} scope="col">
                    {t(`retention.column.${column}`)}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>{children}</tbody>
          </table>
        </div>
      )}
    </Panel>
  );
}

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
    <Table title={t("retention.programs")} columns={["program", ...PARTS]} empty={t("retention.noPrograms")}>
      {retention.calls + retention.calls_archived > 0 ? [...rows, calls] : rows}
    </Table>
  );
}

export function ArchiveTable({ retention }: { retention: Retention }) {
  const { t } = useTranslation();
  const { archives, archive_bytes: size, archive_count: count } = retention;
  const remark = count > 0 ? t("retention.total", { bytes: formatBytes(size), count }) : undefined;
  return (
    <Table title={t("retention.archives")} remark={remark} columns={FILES} empty={t("retention.noArchives")}>
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
    </Table>
  );
}
