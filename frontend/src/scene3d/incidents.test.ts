import { expect, test } from "vitest";
import type { RehearsalResult } from "@/api/types";
import { drawnAt, incidentsOf, isNow } from "./incidents";

const wait = (t: number, duration_s = 4) => ({
  t,
  duration_s,
  robot: "r1",
  reason: "",
  why: { code: "serving", args: {} },
});
const met = (t: number) => ({ t, a: "r1", b: "r2", distance_m: 0.05, x: 3, y: -2 });

function rehearsed(changes: Partial<RehearsalResult>): RehearsalResult {
  const frames = {
    dt_s: 1,
    robots: { r1: Array.from({ length: 20 }, (_, t) => [t, 0, 0] as [number, number, number]) },
  };
  return { collisions: [], near_misses: [], waits: [], frames, ...changes } as unknown as RehearsalResult;
}

test("what came to pass is numbered in time, whatever it is", () => {
  const found = incidentsOf(rehearsed({ waits: [wait(5), wait(9)], near_misses: [met(7)], collisions: [met(6)] }));
  expect(found.map(({ number, kind, t_s }) => [number, kind, t_s])).toEqual([
    [1, "wait", 5],
    [2, "collision", 6],
    [3, "near", 7],
    [4, "wait", 9],
  ]);
});

test("a wait is where its robot stood then, and lasts; who met is where they met", () => {
  const [waited, near] = incidentsOf(rehearsed({ waits: [wait(5)], near_misses: [met(7)] }));
  expect([waited?.at, near?.at]).toEqual([
    [5, 0],
    [3, -2],
  ]);
  expect([4, 5, 9, 9.5].map((t) => waited && isNow(waited, t))).toEqual([false, true, true, false]);
});

test("a robot that was never seen has no place", () => {
  expect(incidentsOf(rehearsed({ waits: [{ ...wait(5), robot: "gone" }] }))[0]?.at).toBeNull();
});

test("few are drawn always, of very many those around the moment", () => {
  const few = incidentsOf(rehearsed({ waits: [wait(5), wait(900)] }));
  expect(drawnAt(few, 0)).toHaveLength(2);
  const many = incidentsOf(rehearsed({ waits: Array.from({ length: 200 }, (_, index) => wait(index * 10)) }));
  expect(drawnAt(many, 1000).map(({ t_s }) => t_s)).toEqual([970, 980, 990, 1000, 1010, 1020, 1030]);
});
