import { expect, test } from "vitest";
import type { SceneRecording } from "../types";
import { loadAt } from "./loads";

const RECORDING: SceneRecording = {
  frames: { dt_s: 0.1, robots: {} },
  carrying: {
    r1: [
      [2, { box: 1 }],
      [5, { box: 0 }],
      [7, { box: 1, paintCan: 2 }],
    ],
  },
  machine_states: {},
  routes: {},
};

test.each([
  ["r1", 0, null],
  ["r1", 2, "box"],
  ["r1", 6, null],
  ["r1", 9, "can"],
  ["r2", 9, null],
])("what %s carries after %s s is seen as %s", (robot, t_s, shape) => {
  expect(loadAt(RECORDING, robot, t_s)).toBe(shape);
});
