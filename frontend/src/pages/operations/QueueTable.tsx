/** What waits at all sites together, with the tasks for workers. */
import { useTranslation } from "react-i18next";
import type { Queue } from "@/api/types";
import { formatNumber, formatSpan } from "@/i18n/format";
import pages from "../pages.module.css";
import { TableSection } from "../section/Section";

const COLUMNS = ["queue", "waiting", "oldest"];

export function QueueTable({ queues }: { queues: readonly Queue[] }) {
  const { t } = useTranslation();
  return (
    <TableSection catalogue="operations" title={t("operations.everywhere")} columns={COLUMNS}>
      {queues.map((queue) => {
        const [kind, name] = queue.name.split(":");
        return (
          <tr key={queue.name}>
            <td className={pages.strong}>{t(`operations.queue.${kind ?? ""}`, { name })}</td>
            <td className={pages.nowrap}>{formatNumber(queue.waiting)}</td>
            <td className={pages.nowrap}>{queue.oldest_s === null ? "–" : formatSpan(queue.oldest_s)}</td>
          </tr>
        );
      })}
    </TableSection>
  );
}
