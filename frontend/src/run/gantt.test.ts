/** What the server has told of a run's timeline goes on here; both read the same journals in the same way. */
import { expect, test } from "vitest";
import type { RunEvent, RunTimeline } from "@/api/types";
import cases from "../../../tests/cases/timelines.json";
import { ganttOf } from "./gantt";

const NOTHING: RunTimeline = { seq: 0, bars: [], steps: [], drives: {}, simulated: [] };
const ROBOTS: Record<string, string> = { go: "robot01", fetch: "robot01", sweep: "robot01" };
const robotOf = (step: string) => ROBOTS[step];

/** A line as the cases have it: seconds, kind, code, step, device, robot, and how an answer was. */
function lineOf([t_s, kind, code, step, device, robot, status]: readonly unknown[], seq: number): RunEvent {
  const args = status === undefined ? {} : { status };
  return { seq, at: "", t_s, kind, code, step, device, robot, text: "", cause: null, args } as RunEvent;
}

const journalOf = (lines: readonly (readonly unknown[])[]) => lines.map((line, at) => lineOf(line, at + 1));

/** A case's bars as those of rows: by device, in the order in which they began. */
const sorted = <B extends readonly unknown[]>(bars: readonly B[]) =>
  [...bars].sort((a, b) => String(a[0]).localeCompare(String(b[0])) || Number(a[3]) - Number(b[3]));

function barsOf(told: RunTimeline, since: readonly RunEvent[]) {
  const bars = ganttOf(told, since, [], robotOf).flatMap((row) => row.bars);
  return bars.map((bar) => [bar.device, bar.step, bar.kind, bar.started_s, bar.ended_s, bar.failed]);
}

test.each(cases)("a journal is read as the server reads it: $name", ({ lines, bars }) => {
  expect(barsOf(NOTHING, journalOf(lines))).toEqual(sorted(bars));
});

test("a timeline that the server has told goes on with what is under way, and stays as it was told", () => {
  const told: RunTimeline = {
    ...NOTHING,
    seq: 5,
    bars: [
      { device: "oven", step: "cure", kind: "work", started_s: 1, ended_s: 3, failed: true, count: 7, pending: 0 },
      { device: "robot01", step: "go", kind: "work", started_s: 2, ended_s: null, failed: false, count: 1, pending: 1 },
      { device: "oven", step: "mix", kind: "work", started_s: 4, ended_s: null, failed: false, count: 1, pending: 2 },
    ],
    steps: ["go"],
    drives: { robot01: "go" },
  };
  const before = structuredClone(told);
  const since = journalOf([
    [6, "answer", "answer", "mix", "oven", "", "DONE"],
    [7, "answer", "answer", "mix", "oven", "", "DONE"],
    [8, "command", "command", "mix", "oven", ""],
    [9, "step", "step_done", "go", "", ""],
  ]);
  const bars = [
    ["oven", "cure", "work", 1, 3, true],
    ["oven", "mix", "work", 4, null, false],
    ["robot01", "go", "work", 2, 9, false],
  ];
  for (let look = 0; look < 2; look += 1) expect(barsOf(told, since)).toEqual(bars);
  expect(told).toEqual(before);
});

test("rows stand in the order of the devices, others behind them", () => {
  const since = journalOf(
    ["oven", "arm", "robot01", "belt"].map((device) => [0, "command", "command", "s", device, ""]),
  );
  const rows = ganttOf(NOTHING, since, ["robot01", "gone", "oven"], robotOf);
  expect(rows.map((row) => row.device)).toEqual(["robot01", "oven", "arm", "belt"]);
});
