/**
 * What a zone for so many robots at once costs: how long they waited in front of it, in rehearsals and in runs, and
 * whether two could pass.
 */
import { useTranslation } from "react-i18next";
import { USE_DAYS } from "@/api/floorUse";
import type { FloorCheck, FloorUse, ZoneCost } from "@/api/types";
import { formatNumber, formatSpan, formatTimeOfDay, withUnit } from "@/i18n/format";
import { metres, shortBy } from "../check/findingWords";
import styles from "./zones.module.css";

type ZoneWidth = FloorCheck["zones"][number];
type ZoneUse = FloorUse["zones"][number];
const BUSY_MIN = 30;
const DAY_MIN = 24 * 60;

const seconds = (value: number) => withUnit(formatNumber(value, value < 10 ? 1 : 0), "s");

interface ZoneCostsProps {
  cost: ZoneCost;
  width: ZoneWidth | undefined;
  use: ZoneUse | undefined;
}

export function ZoneCosts({ cost, width, use }: ZoneCostsProps) {
  return (
    <>
      <Waits cost={cost} />
      {use && use.waits > 0 ? <InRuns use={use} /> : null}
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

/** What waiting there was in runs, and in which half hour of the day most of it. */
function InRuns({ use: { waits, waited_s, busiest_min } }: { use: ZoneUse }) {
  const { t } = useTranslation();
  return (
    <dl className={styles.costs}>
      <div>
        <dt>{t("zone.use.waited", { days: USE_DAYS })}</dt>
        <dd>{t("zone.use.times", { count: waits, time: waited_s < 60 ? seconds(waited_s) : formatSpan(waited_s) })}</dd>
      </div>
      {busiest_min === null ? null : (
        <div>
          <dt>{t("zone.use.busiest")}</dt>
          <dd>
            {t("zone.use.span", {
              from: formatTimeOfDay(busiest_min),
              to: formatTimeOfDay((busiest_min + BUSY_MIN) % DAY_MIN),
            })}
          </dd>
        </div>
      )}
    </dl>
  );
}

function Waits({ cost }: { cost: ZoneCost }) {
  const { t } = useTranslation();
  const { rehearsals: count, waited_s, most_s, waited_in } = cost;
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
