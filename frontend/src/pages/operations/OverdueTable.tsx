/** Commands to which their devices have said nothing for long. */
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices } from "@/api/queries";
import type { Operations, OverdueCommand } from "@/api/types";
import { StatusBadge } from "@/design/StatusBadge";
import { formatSpan } from "@/i18n/format";
import pages from "../pages.module.css";
import { TableSection } from "../section/Section";

const COLUMNS = ["device", "method", "run", "status", "tries", "waits"];

function Row({ slug, command, name }: { slug: string; command: OverdueCommand; name: string }) {
  const { t } = useTranslation();
  return (
    <tr>
      <td className={pages.name}>
        <Link to={`/sites/${slug}/devices/${command.device}`} className={pages.strong}>
          {name}
        </Link>
      </td>
      <td>
        <code>{command.method}</code>
      </td>
      <td className={pages.nowrap}>
        {command.run ? (
          <Link to={`/runs/${command.run}`} className={pages.link}>
            {t("operations.runNumber", { number: command.number ?? "–" })}
          </Link>
        ) : (
          t("operations.byHand")
        )}
      </td>
      <td className={pages.nowrap}>
        <StatusBadge status="warning">{t(`operations.status.${command.status}`)}</StatusBadge>
      </td>
      <td className={pages.optional}>{command.tries}</td>
      <td className={pages.nowrap}>{formatSpan(command.waits_s)}</td>
    </tr>
  );
}

export function OverdueTable({ slug, operations }: { slug: string; operations: Operations }) {
  const { t } = useTranslation();
  const devices = useDevices(slug).data ?? [];
  const names = new Map(devices.map((device) => [device.id, device.name]));
  const { overdue, overdue_count: count } = operations;
  return (
    <TableSection
      catalogue="operations"
      title={t("operations.overdue")}
      count={count}
      remark={count > overdue.length ? t("operations.overdueSome", { count: overdue.length }) : undefined}
      columns={COLUMNS}
      optional={["tries"]}
      empty={t("operations.overdueNone")}
    >
      {overdue.map((command) => (
        <Row key={command.id} slug={slug} command={command} name={names.get(command.device) ?? command.device} />
      ))}
    </TableSection>
  );
}
