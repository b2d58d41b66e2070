/** What a zone for so many robots at once costs: how long they waited in front of it, and whether two could pass. */
import { useTranslation } from "react-i18next";
import type { FloorCheck, ZoneCost } from "@/api/types";
import { formatNumber, withUnit } from "@/i18n/format";
import { metres, shortBy } from "../check/findingWords";
import styles from "./zones.module.css";

type ZoneWidth = FloorCheck["zones"][number];

export function ZoneCosts({ cost, width }: { cost: ZoneCost; width: ZoneWidth | undefined }) {
  return (
    <>
      <Waits cost={cost} />
      {width ? <Passing width={width} /> : null}
    </>
  );
}

/** Whether two robots come past each other in it: where they do, nobody needs to wait. */
function Passing({ width: { width_m, needs_m } }: { width: ZoneWidth }) {
  const { t } = useTranslation();
  const isShort = width_m < needs_m;
  return (
    <dl className={styles.costs}>
      <div data-short={isShort}>
        <dt>{t("floorCheck.passing")}</dt>
        <dd>
          {isShort
            ? t("floorCheck.short", { short: shortBy(width_m, needs_m) })
            : t("floorCheck.passes", { spare: metres(width_m - needs_m) })}
        </dd>
      </div>
    </dl>
  );
}

function Waits({ cost }: { cost: ZoneCost }) {
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
