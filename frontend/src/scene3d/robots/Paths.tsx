/** Where robots came from and where they are going, on the floor. */
import { useFrame, useThree } from "@react-three/fiber";
import { useEffect, useMemo, useRef } from "react";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { ownEntry } from "@/design/ownEntry";
import { latest, straightened, trailBefore } from "../frames";
import { FloorLines } from "../segments";
import type { RobotsProps } from "./props";

const TRAIL_S = 30;
const TRAILS_PER_S = 10;
const NOWHERE: readonly (readonly [number, number])[] = [];

/** Lines on the floor that are written over, in a material of their own. */
function useLines(height_m: number, look: ConstructorParameters<typeof LineMaterial>[0], needs: unknown[]) {
  const lines = useMemo(() => new FloorLines(height_m), [height_m]);
  // oxlint-disable-next-line react/exhaustive-deps -- who calls says what the look depends on
  const material = useMemo(() => new LineMaterial(look), needs);
  const drawn = useMemo(() => new LineSegments2(lines.geometry, material), [lines, material]);
  drawn.frustumCulled = false;
  useEffect(() => () => lines.geometry.dispose(), [lines]);
  useEffect(() => () => material.dispose(), [material]);
  return { lines, drawn };
}

/** The last half minute of each robot's path, renewed four times a second of the recording, ten times of the clock. */
export function Trails({ robots, recording, moment, palette, playing }: RobotsProps & { playing: boolean }) {
  const look = { color: palette.busy, linewidth: 5 };
  const { lines, drawn } = useLines(0.04, look, [palette]);
  const clock = useThree((state) => state.clock);
  const shown = useRef({ step: -1, at_s: 0, of: robots });
  useFrame(() => {
    const step = Math.floor(moment.t_s * 4);
    const now_s = clock.elapsedTime;
    const { current: last } = shown;
    if (step === last.step && last.of === robots) return;
    if (playing && now_s - last.at_s < 1 / TRAILS_PER_S) return;
    shown.current = { step, at_s: now_s, of: robots };
    lines.write(robots.map(({ id }) => trailBefore(recording.frames, id, moment.t_s, TRAIL_S)));
  });
  return <primitive object={drawn} />;
}

/** The paths that robots are on at the moment. */
export function PlannedPaths({ robots, recording, moment, palette }: RobotsProps) {
  const look = { color: palette.motion, linewidth: 2.5, dashed: true, dashSize: 0.25, gapSize: 0.18 };
  const { lines, drawn } = useLines(0.03, look, [palette]);
  const shown = useRef<(readonly (readonly [number, number])[])[]>([]);
  useFrame(() => {
    const paths = robots.map(({ id }) => latest(ownEntry(recording.routes, id), moment.t_s)?.[1] ?? NOWHERE);
    const { current: last } = shown;
    if (paths.length === last.length && paths.every((path, index) => path === last[index])) return;
    shown.current = paths;
    lines.write(paths.map(straightened));
  });
  return <primitive object={drawn} />;
}
