// @vitest-environment jsdom
import { afterEach, expect, test } from "vitest";
import type { FloorPlan } from "@/map/floor/floor";
import type { OpenProgram } from "../state/context";
import { useScreen } from "../state/screen";
import { showSteps } from "./view";

const BEFORE = useScreen.getState();
afterEach(() => useScreen.setState(BEFORE, true));

test("steps at both ends of a large site are brought into view together", () => {
  const plan: FloorPlan = {
    version: 1,
    width: 30,
    height: 20,
    resolution_m: 10,
    origin: { x: 0, y: -200 },
    places: [],
    cells: new Uint8Array(600),
  };
  const zooms: unknown[] = [];
  const flow = { setCenter: (_x: number, _y: number, { zoom }: { zoom: number }) => zooms.push(zoom) };
  useScreen.setState({ stage: { flow, pane: { width: 1420, height: 1360 } } as never });
  const box = (left: number) => ({ box: { left, right: left + 100, top: 0, bottom: 30 } });
  const scene = {
    frames: [],
    chips: new Map([
      ["a", box(0)],
      ["b", box(9900)],
    ]),
  };
  for (const floor of [plan, null])
    showSteps({ scene, plan: floor } as unknown as Pick<OpenProgram, "scene" | "plan">, ["a", "b"]);
  expect(zooms).toEqual([0.1, 0.2]);
});
