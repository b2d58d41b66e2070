/** A machine's outline seen from above, with the drawn details of its class; middle at 0, 0. */
import type { ReactNode } from "react";
import { ownEntry } from "@/design/ownEntry";

interface Size {
  readonly width: number;
  readonly height: number;
}

export function MachineBody({ deviceClass, width, height }: { deviceClass: string } & Size) {
  const details = ownEntry(DETAILS, deviceClass) ?? plain;
  return (
    <g fill="none" stroke="var(--machine-line)">
      <rect
        x={-width / 2}
        y={-height / 2}
        width={width}
        height={height}
        rx={6}
        fill="var(--machine-fill)"
        strokeWidth={1.4}
      />
      <g strokeWidth={1} opacity={0.62}>
        {details({ width, height })}
      </g>
    </g>
  );
}

/** The classes that have details; `BODIES` in `scene3d/machines/bodies.ts` has the same. */
export const DETAILS: Readonly<Record<string, (size: Size) => ReactNode>> = {
  shelf: (size) => grid(size, 4, 2, (x, y, w, h) => <rect key={`${x} ${y}`} x={x} y={y} width={w} height={h} rx={2} />),
  cans: (size) =>
    grid(size, 6, 2, (x, y, w, h) => (
      <circle key={`${x} ${y}`} cx={x + w / 2} cy={y + h / 2} r={Math.min(w, h) / 2.6} />
    )),
  mixer: ({ width, height }) => (
    <>
      <circle r={Math.min(width, height) * 0.42} />
      <rect x={-width / 2 + 5} y={-height / 2 + 5} width={width - 10} height={height - 10} rx={4} />
    </>
  ),
  booth: (size) => stripes(size, 13, "vertical"),
  rollers: (size) => stripes(size, 11, "vertical"),
  oven: (size) => stripes(size, 9, "horizontal"),
};

function plain({ width, height }: Size): ReactNode {
  return <rect x={-width / 2 + 6} y={-height / 2 + 6} width={width - 12} height={height - 12} rx={4} />;
}

function grid(
  { width, height }: Size,
  columns: number,
  rows: number,
  draw: (x: number, y: number, width: number, height: number) => ReactNode,
): ReactNode[] {
  const [inner, tall] = [(width - 12) / columns, (height - 12) / rows];
  return Array.from({ length: columns * rows }, (_, index) => {
    const x = -width / 2 + 6 + (index % columns) * inner + 3;
    const y = -height / 2 + 6 + Math.floor(index / columns) * tall + 3;
    return draw(x, y, inner - 6, tall - 6);
  });
}

function stripes({ width, height }: Size, gap: number, way: "vertical" | "horizontal"): ReactNode {
  const [along, across] = way === "vertical" ? [width, height] : [height, width];
  const count = Math.max(2, Math.floor((along - 16) / gap));
  const path = Array.from({ length: count + 1 }, (_, index) => {
    const at = -along / 2 + 8 + (index * (along - 16)) / count;
    const reach = across / 2 - 7;
    return way === "vertical" ? `M${at} ${-reach}V${reach}` : `M${-reach} ${at}H${reach}`;
  });
  return <path d={path.join("")} />;
}
