/** A brought map is laid on the present one: three points on each, how well they fit, and how both lie then. */
import { Switch } from "@mantine/core";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { formatNumber, withUnit } from "@/i18n/format";
import type { CellMap } from "@/map/floor/rosFiles";
import { UNKNOWN, WALL } from "../plan/picture";
import styles from "./align.module.css";
import { MapPane } from "./MapPane";
import { metresOf, type Alignment, type Side } from "./useAlignment";

interface PanelProps {
  brought: CellMap;
  present: CellMap;
  alignment: Alignment;
}

export function AlignPanel({ brought, present, alignment }: PanelProps) {
  const { t } = useTranslation();
  const { points, put, map } = alignment;
  const both = useMemo(() => (map ? overlaid(present, map) : null), [present, map]);
  const pane = (side: Side, shown: CellMap) => (
    <MapPane
      map={shown}
      title={t(`mapImport.align.${side}`)}
      points={points[side]}
      labelOf={(index, at) => {
        const [x, y] = metresOf(shown, at);
        const where = { number: index + 1, x: formatNumber(x, 2), y: formatNumber(y, 2) };
        return t(`mapImport.align.point.${side}`, where);
      }}
      put={(index, at) => put(side, index, at)}
    />
  );
  return (
    <div className={styles.panel}>
      <p className={styles.help}>{t("mapImport.align.help")}</p>
      <div className={styles.panes}>
        {pane("from", brought)}
        {pane("to", present)}
      </div>
      <Result alignment={alignment} />
      {both ? <MapPane map={both} title={t("mapImport.align.both")} /> : null}
    </div>
  );
}

function Result({ alignment }: { alignment: Alignment }) {
  const { t } = useTranslation();
  const { found, map, keepScale, setKeepScale } = alignment;
  const cm = (metres: number) => withUnit(formatNumber(metres * 100, 1), "cm");
  return (
    <div className={styles.result}>
      <Switch
        label={t("mapImport.align.keepScale")}
        checked={keepScale}
        onChange={(event) => setKeepScale(event.currentTarget.checked)}
      />
      {found ? (
        <p role="status">
          {t("mapImport.align.result", {
            scale: formatNumber(found.by.scale, 4),
            turn: withUnit(formatNumber((found.by.theta * 180) / Math.PI, 2), "°"),
            all: cm(found.all),
          })}
        </p>
      ) : (
        <p role="alert" className={styles.problem}>
          {t("mapImport.align.none")}
        </p>
      )}
      {found && !map ? (
        <p role="alert" className={styles.problem}>
          {t("mapImport.align.tooLarge")}
        </p>
      ) : null}
      <ol className={styles.residuals}>
        {(found?.each ?? []).map((far, index) => (
          <li key={index}>{t("mapImport.align.residual", { number: index + 1, far: cm(far) })}</li>
        ))}
      </ol>
    </div>
  );
}

/** The aligned map with the present one's walls shaded where it has none itself; what it shows is the aligned frame. */
function overlaid(present: CellMap, map: CellMap): CellMap {
  const cells = map.cells.map((cell) => (cell === WALL ? WALL : 0));
  const left = Math.round((present.origin.x - map.origin.x) / map.resolution_m);
  const bottom = Math.round((present.origin.y - map.origin.y) / map.resolution_m);
  present.cells.forEach((cell, index) => {
    if (cell !== WALL) return;
    const [column, row] = [(index % present.width) + left, Math.floor(index / present.width) + bottom];
    if (column < 0 || row < 0 || column >= map.width || row >= map.height) return;
    const at = row * map.width + column;
    if (cells[at] !== WALL) cells[at] = UNKNOWN;
  });
  return { ...map, cells };
}
