/** The site in slanted view, drawn from its real map and devices. */
import { memo, useMemo } from "react";
import { useTranslation } from "react-i18next";
import type { Device, SiteMap } from "@/api/types";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import { statusColour } from "@/design/StatusGlyph";
import { blocksOf, floorBoxes, lookOf, project, wallBlocks, type Block, type Corner } from "./projection";
import styles from "./home.module.css";

const SCALE = 40;
const points = (corners: readonly Corner[]) =>
  corners
    .map(project)
    .map(([x, y]) => `${(x * SCALE).toFixed(1)},${(y * SCALE).toFixed(1)}`)
    .join(" ");

/** The same wall keeps its block, so that only what moved is drawn anew. */
const Solid = memo(function Solid({ block }: { block: Block }) {
  const [left, bottom, right, top] = block.box;
  const h = block.height;
  return (
    <g data-kind={block.kind} className={styles.solid}>
      <polygon
        data-face="left"
        points={points([
          [left, top, 0],
          [left, bottom, 0],
          [left, bottom, h],
          [left, top, h],
        ])}
      />
      <polygon
        data-face="front"
        points={points([
          [left, bottom, 0],
          [right, bottom, 0],
          [right, bottom, h],
          [left, bottom, h],
        ])}
      />
      <polygon
        data-face="top"
        points={points([
          [left, bottom, h],
          [right, bottom, h],
          [right, top, h],
          [left, top, h],
        ])}
      />
    </g>
  );
});

/** The floor, or its shadow below it. */
const Slab = memo(function Slab({ floor, className, lower }: SlabProps) {
  return (
    <g className={className} transform={lower ? `translate(0 ${lower})` : undefined}>
      {floor.map(([left, bottom, right, top], index) => (
        <polygon
          key={index}
          points={points([
            [left, bottom, 0],
            [right, bottom, 0],
            [right, top, 0],
            [left, top, 0],
          ])}
        />
      ))}
    </g>
  );
});

interface SlabProps {
  floor: readonly Block["box"][];
  className: string | undefined;
  lower?: number;
}

/** A sign above a machine: its icon, ringed in the colour of its status. */
function Sign({ block }: { block: Block }) {
  if (!block.device) return null;
  const [left, bottom, right, top] = block.box;
  const [x, y] = project([(left + right) / 2, (bottom + top) / 2, block.height]);
  const small = block.kind === "robot";
  const size = small ? 30 : 46;
  return (
    <g transform={`translate(${x * SCALE} ${y * SCALE})`} style={{ color: "var(--text)" }}>
      <ellipse
        rx={size * 0.62}
        ry={size * 0.5}
        fill="var(--panel)"
        stroke={statusColour(block.device.status)}
        strokeWidth={2.5}
      />
      <DeviceIcon deviceClass={block.device.device_class} size={size * 0.62} x={-size * 0.31} y={-size * 0.31} />
    </g>
  );
}

function boundsOf(floor: readonly Block["box"][]) {
  const corners = floor.flatMap(([left, bottom, right, top]): Corner[] => [
    [left, bottom, 0],
    [right, bottom, 0],
    [left, top, 1.2],
    [right, top, 1.2],
  ]);
  const [xs, ys] = [corners.map((each) => project(each)[0] * SCALE), corners.map((each) => project(each)[1] * SCALE)];
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return `${x - 20} ${y - 10} ${Math.max(...xs) - x + 40} ${Math.max(...ys) - y + 40}`;
}

interface FactoryPictureProps {
  map: SiteMap;
  devices: readonly Device[];
}

function Picture({ map, devices }: FactoryPictureProps) {
  const { t } = useTranslation();
  const floor = useMemo(() => floorBoxes(map), [map]);
  const walls = useMemo(() => wallBlocks(map), [map]);
  const bounds = useMemo(() => boundsOf(floor), [floor]);
  const blocks = blocksOf(walls, devices);
  if (floor.length === 0) return null;
  return (
    <svg className={styles.picture} viewBox={bounds} role="img" aria-label={t("pages.home.picture")}>
      <Slab floor={floor} className={styles.ground} lower={14} />
      <Slab floor={floor} className={styles.floor} />
      {blocks.map((block) => (
        <Solid key={block.key} block={block} />
      ))}
      {blocks.map((block) => (
        <Sign key={block.key} block={block} />
      ))}
    </svg>
  );
}

/** Drawn anew only when something in it looks different. */
export const FactoryPicture = memo(
  Picture,
  (before, after) => before.map === after.map && lookOf(before.devices) === lookOf(after.devices),
);
