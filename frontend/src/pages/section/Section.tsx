/** A part of a page of figures: its heading with what there is to say of it, and under it a table or whatever else. */
import type { ReactNode, Ref } from "react";
import { useTranslation } from "react-i18next";
import { Chip } from "@/design/Chip";
import { Panel } from "@/design/Panel";
import pages from "../pages.module.css";
import styles from "./section.module.css";

interface SectionProps {
  title: string;
  count?: number;
  /** A short remark behind the title. */
  remark?: string;
  /** For who brings the focus to the heading. */
  heading?: Ref<HTMLHeadingElement>;
  children: ReactNode;
}

export function Section({ title, count, remark, heading, children }: SectionProps) {
  return (
    <Panel className={styles.section} aria-label={title}>
      <div className={styles.head}>
        <h2 ref={heading} tabIndex={heading ? -1 : undefined}>
          {title}
        </h2>
        {count === undefined ? null : <Chip>{count}</Chip>}
        {remark ? <span>{remark}</span> : null}
      </div>
      {children}
    </Panel>
  );
}

/** What stands in a section that has nothing to show. */
export function NothingHere({ children }: { children: ReactNode }) {
  return <p className={styles.empty}>{children}</p>;
}

interface TableSectionProps extends Omit<SectionProps, "children" | "heading"> {
  /** The catalogue that has the columns' names under `column`. */
  catalogue: string;
  columns: readonly string[];
  /** Columns that are left out where there is little room. */
  optional?: readonly string[];
  /** What stands there instead of a table without rows. */
  empty?: string;
  children: ReactNode[];
}

/** A section with a table, which is scrolled sideways by itself where it is too wide. */
export function TableSection(props: TableSectionProps) {
  const { catalogue, columns, optional = [], empty, children, ...head } = props;
  const { t } = useTranslation();
  return (
    <Section {...head}>
      {children.length === 0 && empty ? (
        <NothingHere>{empty}</NothingHere>
      ) : (
        <div className={pages.scroll}>
          <table className={pages.table}>
            <thead>
              <tr>
                {columns.map((column) => (
                  <th key={column} scope="col" className={optional.includes(column) ? pages.optional : undefined}>
                    {t(`${catalogue}.column.${column}`)}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>{children}</tbody>
          </table>
        </div>
      )}
    </Section>
  );
}
