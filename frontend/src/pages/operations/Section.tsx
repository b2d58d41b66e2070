/** A table of this page with its heading, scrolled sideways by itself where it is too wide. */
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Chip } from "@/design/Chip";
import { Panel } from "@/design/Panel";
import pages from "../pages.module.css";
import styles from "./operations.module.css";

interface SectionProps {
  title: string;
  count?: number;
  /** A short remark behind the title. */
  remark?: string;
  columns: readonly string[];
  /** Columns that are left out where there is little room. */
  optional?: readonly string[];
  /** What stands there instead of a table without rows. */
  empty?: string;
  children: ReactNode[];
}

export function Section({ title, count, remark, columns, optional = [], empty, children }: SectionProps) {
  const { t } = useTranslation();
  return (
    <Panel className={styles.section} aria-label={title}>
      <div className={styles.head}>
        <h2>{title}</h2>
        {count === undefined ? null : <Chip>{count}</Chip>}
        {remark ? <span>{remark}</span> : null}
      </div>
      {children.length === 0 && empty ? (
        <p className={styles.empty}>{empty}</p>
      ) : (
        <div className={pages.scroll}>
          <table className={pages.table}>
            <thead>
              <tr>
                {columns.map((column) => (
                  <th key={column} scope="col" className={optional.includes(column) ? pages.optional : undefined}>
                    {t(`operations.column.${column}`)}
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
