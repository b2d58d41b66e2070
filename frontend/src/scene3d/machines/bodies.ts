/** What machines look like, by their class. Pure. */
import { ownEntry } from "@/design/ownEntry";
import type { Palette } from "../palette";
import type { Solid } from "../solids";
import type { SceneDevice } from "../types";

type Size = SceneDevice["size"];
type Triple = readonly [number, number, number];

/** A part that shines by itself. */
export interface Glowing {
  readonly at: Triple;
  readonly box: Triple;
  readonly color: string;
  readonly glow: number;
}

export interface Body {
  readonly solids: readonly Solid[];
  readonly glowing: readonly Glowing[];
}

const box = (at: Triple, size: Triple, color: string): Solid => ({ at, box: size, color });

const can = (at: Triple, radius: number, height: number, color: string): Solid => ({
  at,
  can: { radius, height },
  color,
});

const glowing = (at: Triple, size: Triple, color: string, glow: number): Glowing => ({ at, box: size, color, glow });

/** Evenly spaced positions along a length, centred. */
const spread = (count: number, length: number) =>
  Array.from({ length: count }, (_, index) => (index + 0.5) * (length / count) - length / 2);

function shelf(size: Size, palette: Palette): Body {
  const boards = [0.06, 0.5, 0.94].map((y) => box([0, y, 0], [size.x, 0.06, size.y], palette.bodyDark));
  const boxes = [0.27, 0.71, 1.15].flatMap((y) =>
    spread(4, size.x).flatMap((x) =>
      spread(2, size.y).map((z) => box([x, y, z], [size.x / 4.6, 0.34, size.y / 2.6], palette.warnFill)),
    ),
  );
  return { solids: [...boards, ...boxes], glowing: [] };
}

function cans(size: Size, palette: Palette): Body {
  const colors = [palette.machine, palette.error, palette.warnFill, palette.motion, palette.done];
  const boards = [0.06, 0.5].map((y) => box([0, y, 0], [size.x, 0.06, size.y], palette.bodyDark));
  const rows = [0.27, 0.71].flatMap((y, level) =>
    spread(6, size.x).flatMap((x, column) =>
      spread(2, size.y).map((z, row) =>
        can([x, y, z], 0.15, 0.34, colors[(column + row * 2 + level) % 5] ?? palette.machine),
      ),
    ),
  );
  return { solids: [...boards, ...rows], glowing: [] };
}

function mixer(size: Size, palette: Palette): Body {
  const width = Math.min(size.x, size.y);
  const solids = [
    box([0, 0.1, 0], [size.x, 0.2, size.y], palette.bodyDark),
    can([0, 0.62, 0], width * 0.34, 0.85, palette.body),
    can([0, 1.1, 0], width * 0.24, 0.12, palette.bodyDark),
    can([0, 1.3, 0], 0.09, 0.3, palette.machine),
  ];
  return { solids, glowing: [] };
}

function booth(size: Size, palette: Palette): Body {
  const solids = [
    box([0, 0.22, size.y * 0.2], [size.x, 0.12, size.y * 0.6], palette.bodyDark),
    ...spread(8, size.x).map((x) => box([x, 0.3, size.y * 0.2], [0.1, 0.06, size.y * 0.55], palette.body)),
    box([0, 0.75, -size.y * 0.18], [size.x * 0.86, 1.5, size.y * 0.6], palette.body),
  ];
  return { solids, glowing: [glowing([0, 0.7, size.y * 0.125], [size.x * 0.6, 0.62, 0.03], palette.motion, 0.35)] };
}

function oven(size: Size, palette: Palette): Body {
  const front = size.y / 2 + 0.01;
  const solids = [
    box([0, 0.7, 0], [size.x, 1.4, size.y], palette.body),
    box([-size.x * 0.2, 1.46, 0], [size.x * 0.35, 0.12, size.y * 0.5], palette.bodyDark),
    can([size.x * 0.3, 1.6, 0], 0.14, 0.5, palette.bodyDark),
  ];
  const lit = [
    glowing([-size.x * 0.12, 0.55, front], [size.x * 0.5, 0.5, 0.04], palette.warnFill, 0.8),
    glowing([size.x * 0.32, 0.85, front], [size.x * 0.16, 0.24, 0.04], palette.busy, 0.6),
  ];
  return { solids, glowing: lit };
}

function rollers(size: Size, palette: Palette): Body {
  const turn = [Math.PI / 2, 0, 0] as const;
  const rolls = spread(9, size.x).map((x) => ({
    at: [x, 0.4, 0] as const,
    turn,
    can: { radius: 0.07, height: size.y * 0.94, sides: 12 },
    color: palette.body,
  }));
  return { solids: [box([0, 0.3, 0], [size.x, 0.14, size.y], palette.bodyDark), ...rolls], glowing: [] };
}

function plain(size: Size, palette: Palette): Body {
  const height = Math.max(size.z, 0.4);
  return { solids: [box([0, height / 2, 0], [size.x, height, size.y], palette.body)], glowing: [] };
}

/** The classes that have a body of their own; `DETAILS` in `map/devices/MachineBody.tsx` has the same. */
export const BODIES: Readonly<Record<string, (size: Size, palette: Palette) => Body>> = {
  shelf,
  cans,
  mixer,
  booth,
  oven,
  rollers,
};

/** The body of a class of machine; a class without a model gets a box of its size. */
export function bodyOf(deviceClass: string, size: Size, palette: Palette): Body {
  return (ownEntry(BODIES, deviceClass) ?? plain)(size, palette);
}

export const LAMP_HEIGHT_M = 1.9;

/** Where the post of a machine's lamps stands, beside its corner. */
export const lampAt = (size: Size) => [size.x / 2 + 0.18, size.y / 2 + 0.05] as const;

/** The yellow line on the floor around a machine, and the post of its lamps. */
export function surroundingsOf(size: Size, palette: Palette): Solid[] {
  const [w, d, t] = [size.x + 0.5, size.y + 0.5, 0.05];
  const bars = [
    [0, d / 2, w, t],
    [0, -d / 2, w, t],
    [w / 2, 0, t, d],
    [-w / 2, 0, t, d],
  ] as const;
  const [x, z] = lampAt(size);
  const post = { radius: 0.03, height: LAMP_HEIGHT_M, sides: 8 };
  return [
    ...bars.map(([atX, atZ, wide, deep]) => box([atX, 0.012, atZ], [wide, 0.01, deep], palette.warnFill)),
    { at: [x, LAMP_HEIGHT_M / 2, z], can: post, color: palette.bodyDark },
  ];
}
