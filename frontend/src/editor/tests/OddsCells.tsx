/** How long a test takes with many seeds, and how often it fails: as figures, and drawn on one scale for all rows. */
import { useTranslation } from "react-i18next";
import type { TestOdds } from "@/api/types";
import { formatClock } from "@/i18n/format";
import { formatShare, type Scale } from "./odds";
import classes from "./tests.module.css";

const percent = (share: number) => `${String(100 * share)}%`;

export function OddsCells({ odds, scale, stale }: { odds: TestOdds | null; scale: Scale | null; stale: boolean }) {
  const { t } = useTranslation();
  if (!odds || odds.seeds === 0) return <span className={classes.odds} />;
  const share = odds.failed / odds.seeds;
  const said = {
    failed: odds.failed,
    seeds: odds.seeds,
    ...{ share: formatShare(share), low: formatShare(odds.low), high: formatShare(odds.high) },
  };
  return (
    <span className={classes.odds} data-stale={stale || undefined} title={t("tests.odds_words", said)}>
      <span className={classes.times}>
        {odds.took_s && scale ? <TimeBar odds={odds} scale={scale} /> : null}
        <small>
          <span className="visually-hidden">{t("tests.p50_p95")} </span>
          {odds.took_s ? `${formatClock(odds.took_s.median)}–${formatClock(odds.took_s.p95)}` : "–"}
        </small>
      </span>
      <span className={classes.share} data-fails={odds.failed > 0 || undefined}>
        <span className={classes.range} aria-hidden="true">
          <i style={{ left: percent(odds.low), right: percent(1 - odds.high) }} />
          <b style={{ left: percent(share) }} />
        </span>
        <span className="visually-hidden">{t("tests.odds")} </span>
        <strong>{formatShare(share)}</strong>
        <small>{t("tests.odds_short", said)}</small>
      </span>
    </span>
  );
}

/** From the least to the most as a line, from the middle to the 95th percentile as a bar. */
function TimeBar({ odds, scale }: { odds: TestOdds; scale: Scale }) {
  const took = odds.took_s;
  if (!took) return null;
  const wide = scale.to_s - scale.from_s;
  const at = (value: number) => percent(wide > 0 ? (value - scale.from_s) / wide : 0);
  const to = (value: number) => percent(wide > 0 ? (scale.to_s - value) / wide : 0);
  return (
    <span className={classes.bar} aria-hidden="true">
      <i style={{ left: at(took.least), right: to(took.most) }} />
      <b style={{ left: at(took.median), right: to(took.p95) }} />
    </span>
  );
}
