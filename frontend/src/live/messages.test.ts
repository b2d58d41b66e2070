import { expect, test } from "vitest";
import type { Question, Device, Program, RunEvent, RunStatus, RunSummary, RunTimeline } from "@/api/types";
import {
  applyChanges,
  applyChecked,
  applyOpenRun,
  applyQuestion,
  applyRehearsal,
  applyRun,
  applyJournalLine,
  applyRunEvent,
  applyTimelineLine,
  isOpen,
  isUrgent,
  joinChanges,
} from "./messages";

const mixer = { id: "mixer", name: "Paint Mixer", status: "idle", doing: "", carrying: {} } as unknown as Device;
const robot = { id: "robot", name: "TurtleBot", status: "busy", doing: "", carrying: { box: 1 } } as unknown as Device;

test("a device that nobody has seen yet is shown at once", () => {
  expect(isUrgent(undefined, { id: "mixer" })).toBe(true);
});

test("a new status or load is shown at once, a pose may wait", () => {
  expect(isUrgent(mixer, { id: "mixer", status: "busy" })).toBe(true);
  expect(isUrgent(robot, { id: "robot", carrying: {} })).toBe(true);
  expect(isUrgent(robot, { id: "robot", location: { x: 1, y: 2, z: 0, theta: 0 } })).toBe(false);
});

test("saying the same status again is no news", () => {
  expect(isUrgent(robot, { id: "robot", status: "busy", carrying: { box: 1 } })).toBe(false);
});

test("of two changes the later one wins where both speak", () => {
  const first = { id: "mixer", status: "busy", doing: "mixPaint" } as const;
  expect(joinChanges(first, { id: "mixer", status: "idle" })).toEqual({
    id: "mixer",
    status: "idle",
    doing: "mixPaint",
  });
  expect(joinChanges(undefined, first)).toBe(first);
});

test("changes reach their devices, strangers are named, others stay the same objects", () => {
  const changes = new Map([
    ["mixer", { id: "mixer", doing: "mixPaint" }],
    ["new", { id: "new" }],
  ]);
  const { devices, strangers } = applyChanges([mixer, robot], changes);
  expect(devices[0]).toEqual({ ...mixer, doing: "mixPaint" });
  expect(devices[1]).toBe(robot);
  expect(strangers).toEqual(["new"]);
});

const run = (id: string, number: number, status = "running") => ({ id, number, status }) as unknown as RunSummary;

test("a run takes its place by number and is never there twice", () => {
  const runs = [run("b", 2), run("a", 1)];
  expect(applyRun(runs, run("c", 3)).map((each) => each.id)).toEqual(["c", "b", "a"]);
  expect(applyRun(runs, run("a", 1, "finished")).map((each) => each.status)).toEqual(["running", "finished"]);
});

test("a list of open runs has a run until it is over", () => {
  const runs = [run("b", 2), run("a", 1)];
  expect(applyOpenRun(runs, run("c", 3, "pending")).map((each) => each.id)).toEqual(["c", "b", "a"]);
  expect(applyOpenRun(runs, run("a", 1, "paused")).map((each) => each.status)).toEqual(["running", "paused"]);
  for (const over of ["finished", "failed", "cancelled"])
    expect(applyOpenRun(runs, run("a", 1, over)).map((each) => each.id)).toEqual(["b"]);
});

const event = (seq: number) => ({ seq }) as unknown as RunEvent;

test("an event that comes late is put in order, one that comes twice is left out", () => {
  const events = [event(1), event(3)];
  expect(applyRunEvent(events, event(2)).map((each) => each.seq)).toEqual([1, 2, 3]);
  expect(applyRunEvent(events, event(3))).toBe(events);
});

const part = (seqs: number[], next?: string) => ({ items: seqs.map(event), next, headers: new Headers() });

test("a new line of a journal goes to its newest part, and one that an older part has nowhere", () => {
  const journal = { pages: [part([8, 9], "?before=8"), part([5, 6, 7], "?before=5")], pageParams: ["", "?before=8"] };
  const numbers = (seq: number) =>
    applyJournalLine(journal, event(seq)).pages.map(({ items }) => items.map((each) => each.seq));
  expect(numbers(10)).toEqual([
    [8, 9, 10],
    [5, 6, 7],
  ]);
  for (const known of [9, 6, 2]) expect(applyJournalLine(journal, event(known))).toBe(journal);
  const first = applyJournalLine({ pages: [part([])], pageParams: [""] }, event(1));
  expect(applyJournalLine(first, event(2)).pages[0]?.items).toEqual([event(1), event(2)]);
});

test("a timeline goes on with the lines after those that the server has read for it", () => {
  const timeline = { told: { seq: 7 } as RunTimeline, since: [event(8)] };
  expect(applyTimelineLine(timeline, event(7))).toBe(timeline);
  expect(applyTimelineLine(timeline, event(9)).since).toEqual([event(8), event(9)]);
});

const question = (id: string, asked_at: string, state = "open") => ({ id, asked_at, state }) as Question;

test("a question takes its place by its time and is replaced when it is answered", () => {
  const questions = [question("a", "2026-01-01T10:00"), question("c", "2026-01-01T12:00")];
  const more = applyQuestion(questions, question("b", "2026-01-01T11:00"));
  expect(more.map((each) => each.id)).toEqual(["a", "b", "c"]);
  expect(applyQuestion(more, question("b", "2026-01-01T11:00", "answered")).map((each) => each.state)).toEqual([
    "open",
    "answered",
    "open",
  ]);
});

test("a check changes what the list shows of its program and nothing else", () => {
  const before = { kinds: [], devices: [], places: [], edited_at: "2026-01-01T10:00", edited_by: null };
  const programs: Program[] = [
    { ...before, id: "a", site: "hall", name: "Paint", errors: 0, warnings: 2 },
    { ...before, id: "b", site: "hall", name: "Carry", errors: 0, warnings: 0 },
  ];
  const edited_by = { id: 3, name: "Otto Brandt", initials: "OB" };
  const told = {
    kinds: ["ask" as const],
    devices: ["oven"],
    places: ["dock"],
    edited_at: "2026-01-01T11:00",
    edited_by,
  };
  const shown = { ...told, errors: 3, warnings: 1 };
  expect(applyChecked(programs, { program: "a", revision: 7, shown })).toEqual([
    { id: "a", site: "hall", name: "Paint", ...shown },
    programs[1],
  ]);
  expect(applyChecked(programs, { program: "gone", revision: 7, shown })).toEqual(programs);
});

test("how far a rehearsal is never jumps back, except where it is begun anew", () => {
  const told = (progress: number, tries = 1, status: "running" | "queued" = "running") => ({
    id: "r",
    status,
    progress,
    course: null,
    tries,
  });
  const shown = { ...told(0.5), name: "Task" };
  expect(applyRehearsal(shown, told(0.6)).progress).toBe(0.6);
  expect(applyRehearsal(shown, told(0.4))).toBe(shown);
  expect(applyRehearsal(shown, told(0, 1, "queued"))).toEqual({ ...shown, status: "queued", progress: 0 });
  expect(applyRehearsal(shown, told(0.1, 2)).progress).toBe(0.1);
});

test("a run is not over while it waits, runs or is paused", () => {
  const statuses: RunStatus[] = ["pending", "running", "paused", "finished", "failed", "cancelled"];
  expect(statuses.filter((status) => isOpen({ status } as RunSummary))).toEqual(["pending", "running", "paused"]);
});
