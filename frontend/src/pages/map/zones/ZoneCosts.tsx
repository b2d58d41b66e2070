/** What a zone for so many robots at once has cost in rehearsals: how long they waited in front of it. */
import { useTranslation } from "react-i18next";
import type { ZoneCost } from "@/api/types";
import { formatNumber, withUnit } from "@/i18n/format";
import styles from "./zones.module.css";

export function ZoneCosts({ cost }: { cost: ZoneCost }) {
  const { t } = useTranslation();
  const { rehearsals: count, waited_s, most_s, waited_in } = cost;
  const seconds = (value: number) => withUnit(formatNumber(value, value < 10 ? 1 : 0), "s");
  if (count === 0) return <p className={styles.costs}>{t("zone.cost.unknown")}</p>;
  if (waited_in === 0) return <p className={styles.costs}>{t("zone.cost.nothing", { count })}</p>;
  return (
    <dl className={styles.costs}>
      <div>
        <dt>{t("zone.cost.mean")}</dt>
        <dd>{t("zone.cost.each", { time: seconds(waited_s) })}</dd>
      </div>
      <div>
        <dt>{t("zone.cost.most")}</dt>
        <dd>{seconds(most_s)}</dd>
      </div>
      <div>
        <dt>{t("zone.cost.of", { count })}</dt>
        <dd>{t("zone.cost.waitedIn", { count: waited_in })}</dd>
      </div>
    </dl>
  );
}
