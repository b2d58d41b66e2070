import { describe, expect, it } from "vitest";
import type { RunEvent } from "@/api/types";
import { ganttOf } from "./gantt";

let seq = 0;
const event = (t_s: number, code: string, more: Partial<RunEvent> = {}): RunEvent => ({
  seq: (seq += 1),
  at: "2026-01-01T00:00:00Z",
  t_s,
  kind: code === "wait_over" ? "wait" : code,
  step: "s1",
  device: "robot01",
  robot: "",
  text: "",
  cause: null,
  code,
  args: {},
  ...more,
});
const done = { args: { status: "DONE" } };

const nobody = () => undefined;

describe("ganttOf", () => {
  it("joins the pieces of one way to one bar", () => {
    const rows = ganttOf(
      [
        event(0, "command"),
        event(1, "command"),
        event(2, "answer", done),
        event(4, "answer", done),
        event(5, "command"),
        event(7, "answer", done),
      ],
      ["robot01"],
      nobody,
    );
    expect(rows).toEqual([
      {
        device: "robot01",
        bars: [{ device: "robot01", step: "s1", kind: "work", started_s: 0, ended_s: 7, failed: false }],
      },
    ]);
  });

  it("parts bars of different steps and keeps what goes on open", () => {
    const rows = ganttOf(
      [event(0, "command"), event(2, "answer", done), event(3, "command", { step: "s2" })],
      [],
      nobody,
    );
    expect(rows[0]?.bars.map((bar) => [bar.step, bar.ended_s])).toEqual([
      ["s1", 2],
      ["s2", null],
    ]);
  });

  it("draws waits, and failures as failed", () => {
    const rows = ganttOf(
      [
        event(0, "blocked", { kind: "wait", robot: "robot02", device: "" }),
        event(4, "wait_over", { robot: "robot02", device: "" }),
        event(5, "command", { device: "oven" }),
        event(6, "answer", { device: "oven", args: { status: "FAILED" } }),
      ],
      ["oven", "robot02"],
      nobody,
    );
    expect(rows.map((row) => [row.device, row.bars[0]?.kind, row.bars[0]?.failed])).toEqual([
      ["oven", "work", true],
      ["robot02", "wait", false],
    ]);
  });

  it("ends what was done for a step that was broken off, as failed", () => {
    const rows = ganttOf(
      [
        event(0, "step_entered", { kind: "step", step: "go" }),
        event(1, "way", { kind: "way", step: "", robot: "robot01" }),
        event(2, "command", { device: "oven", step: "cure" }),
        event(3, "blocked", { kind: "wait", step: "go", robot: "robot01", device: "" }),
        event(9, "step_cancelled", { kind: "step", step: "go" }),
        event(9, "step_cancelled", { kind: "step", step: "cure" }),
      ],
      ["robot01", "oven"],
      () => "robot01",
    );
    expect(rows.flatMap((row) => row.bars).map((bar) => [bar.device, bar.kind, bar.ended_s, bar.failed])).toEqual([
      ["robot01", "work", 9, true],
      ["robot01", "wait", 9, false],
      ["oven", "work", 9, true],
    ]);
  });

  it("draws a drive from setting out to the robot's next command or the step's end", () => {
    const way = { kind: "way", step: "", robot: "robot01" };
    const rows = ganttOf(
      [
        event(0, "step_entered", { kind: "step", step: "go" }),
        event(1, "way", way),
        event(9, "step_done", { kind: "step", step: "go" }),
        event(9, "step_entered", { kind: "step", step: "fetch" }),
        event(10, "way", way),
        event(20, "command", { step: "fetch" }),
        event(21, "answer", { step: "fetch", ...done }),
      ],
      ["robot01"],
      () => "robot01",
    );
    expect(rows[0]?.bars.map((bar) => [bar.step, bar.started_s, bar.ended_s])).toEqual([
      ["go", 1, 9],
      ["fetch", 10, 21],
    ]);
  });
});
