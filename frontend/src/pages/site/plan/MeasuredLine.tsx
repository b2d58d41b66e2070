/** The line of known length over a picture: two ends that are dragged, or moved by the arrow keys. */
import { useTranslation } from "react-i18next";
import { Handle, within } from "./Handle";
import type { Picture, Pixel } from "./picture";
import styles from "./plan.module.css";

export type Line = readonly [Pixel, Pixel];

interface LineProps {
  picture: Picture;
  line: Line;
  /** Pixels of the picture that a pixel of the screen is wide. */
  scale: number;
  change: (line: Line) => void;
}

export function MeasuredLine({ picture, line, scale, change }: LineProps) {
  const { t } = useTranslation();
  const put = (end: 0 | 1, at: Pixel) => {
    const moved = within(picture, at);
    change(end === 0 ? [moved, line[1]] : [line[0], moved]);
  };
  const [[x1, y1], [x2, y2]] = line;
  return (
    <svg className={styles.line} viewBox={`0 0 ${String(picture.width)} ${String(picture.height)}`}>
      <line x1={x1} y1={y1} x2={x2} y2={y2} className={styles.casing} />
      <line x1={x1} y1={y1} x2={x2} y2={y2} className={styles.measure} />
      {([0, 1] as const).map((end) => {
        const [x, y] = line[end];
        return (
          <Handle
            key={end}
            at={line[end]}
            label={t(`mapEdit.plan.end${String(end)}`, { x: Math.round(x), y: Math.round(y) })}
            scale={scale}
            put={(at) => put(end, at)}
          >
            <circle r={8} />
          </Handle>
        );
      })}
    </svg>
  );
}
