/** Who does the jobs that only one process may do. */
import type { TFunction } from "i18next";
import { useTranslation } from "react-i18next";
import type { Lease } from "@/api/types";
import { formatSpan } from "@/i18n/format";
import pages from "../pages.module.css";
import { TableSection } from "../section/Section";
import styles from "./operations.module.css";

const COLUMNS = ["job", "holder", "held"];

const OF_SITE = "site:";

function jobWords(job: string, t: TFunction): string {
  if (job.startsWith(OF_SITE)) return t("operations.runsOf", { site: job.slice(OF_SITE.length) });
  return t(`operations.job.${job}`, { defaultValue: job });
}

export function LeaseTable({ leases }: { leases: readonly Lease[] }) {
  const { t } = useTranslation();
  return (
    <TableSection catalogue="operations" title={t("operations.leases")} columns={COLUMNS}>
      {leases.map((lease) => (
        <tr key={lease.job}>
          <td className={pages.strong}>{jobWords(lease.job, t)}</td>
          <td className={styles.holder}>{lease.holder}</td>
          <td className={pages.nowrap}>{lease.held_s > 0 ? formatSpan(lease.held_s) : t("operations.leaseFree")}</td>
        </tr>
      ))}
    </TableSection>
  );
}
