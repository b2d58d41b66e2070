import { expect, test } from "vitest";
import type { Thread } from "@/api/types";
import { momentOf, momentPath, threadsOfRun } from "./moments";

const NOTHING = { root: null, id: null, to: null, x: null, y: null, run: null, number: null, t_s: null };

function thread(id: string, anchor: Partial<Thread["anchor"]>, started_at = "2026-01-02T03:04:00Z"): Thread {
  const none = { stands: true, resolved_at: null, resolved_by: null, comments: [], unread: 0, label: "" };
  return { id, anchor: { kind: "program", ...NOTHING, ...anchor }, started_at, ...none };
}

const at = (t_s: number, run = "r") => ({ kind: "moment", run, number: 3, t_s }) as const;

test("only a thread about a moment has one, and its address opens the thread", () => {
  const moment = momentOf(thread("a", at(0)));
  expect(moment).toEqual({ run: "r", number: 3, t_s: 0 });
  expect(moment && momentPath(moment, "a")).toBe("/runs/r?thread=a");
  expect(momentOf(thread("b", { kind: "place", x: 1, y: 2 }))).toBeNull();
});

test("a run has its own threads alone, in the order of their moments, then of their beginning", () => {
  const threads = [
    thread("late", at(50)),
    thread("second", at(5), "2026-01-02T03:05:00Z"),
    thread("first", at(5)),
    thread("other", at(1, "another run")),
    thread("program", {}),
  ];
  expect(threadsOfRun(threads, "r").map((each) => [each.thread.id, each.t_s])).toEqual([
    ["first", 5],
    ["second", 5],
    ["late", 50],
  ]);
});
