/** The newest measurements from left to right, on the band of the usual ones; the line is the model's own time. */
import { useTranslation } from "react-i18next";
import type { MethodPace } from "@/api/types";
import { formatNumber } from "@/i18n/format";
import styles from "./paces.module.css";
import { stripOf } from "./paces";

const [WIDTH, HEIGHT] = [132, 32];

export function PaceStrip({ pace }: { pace: MethodPace }) {
  const { t } = useTranslation();
  const strip = stripOf(pace);
  if (!strip) return null;
  const [top, bottom] = strip.band;
  const label = t("device.paces.strip", {
    method: pace.method,
    times: formatNumber(strip.dots.length),
    low: formatNumber(strip.low, 2),
    high: formatNumber(strip.high, 2),
  });
  return (
    <svg className={styles.strip} viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label={label}>
      <rect y={top * HEIGHT} width={WIDTH} height={Math.max(1, (bottom - top) * HEIGHT)} className={styles.band} />
      <line x2={WIDTH} y1={strip.model * HEIGHT} y2={strip.model * HEIGHT} className={styles.model} />
      {strip.dots.map((dot) => (
        <circle
          key={dot.x}
          cx={dot.x * WIDTH}
          cy={dot.y * HEIGHT}
          r={1.9}
          data-changed={(pace.change && dot.newest) || undefined}
          className={styles.dot}
        />
      ))}
    </svg>
  );
}
