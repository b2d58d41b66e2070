import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type Step } from "../document/document";
import { type Spot } from "../surroundings";
import { Standing } from "./standing";

const spot = (x: number): Spot => ({ at: { x, y: 0 }, place: { point: [x, 0] } }) as unknown as Spot;
const step = (kind: string, parent: string, branch: string, order: string): Step => ({
  kind,
  place: [parent, branch, order],
  pos: [0, 0],
  params: {},
});

/** Goes through the steps in order; `moves` says where a step leaves the robot. Returns where each begins. */
function follow(kind: "if" | "parallel", branches: readonly string[], moves: Record<string, number>) {
  const steps = {
    first: step("move", "program", "body", "A"),
    head: step(kind, "program", "body", "B"),
    ...Object.fromEntries(branches.map((branch) => [branch, step("move", "head", branch, "A")])),
    last: step("move", "program", "body", "C"),
  };
  const standing = new Standing({ ...EMPTY_DOCUMENT, steps });
  return Object.keys(steps).map((id) => {
    standing.begin(id);
    const from = standing.get("robot")?.at.x;
    const to = moves[id];
    if (to !== undefined) standing.set("robot", spot(to));
    return [id, from];
  });
}

test("each branch begins where the steps before leave the robot, and what differs behind them is not known", () => {
  const seen: unknown = Object.fromEntries(follow("if", ["then", "else"], { first: 1, then: 2, else: 3 }));
  expect(seen).toEqual({ first: undefined, head: 1, then: 1, else: 1, last: undefined });
});

test("where both branches lead to one place it stands there, and with one branch alone only if it does not move", () => {
  expect(follow("if", ["then", "else"], { first: 1, then: 2, else: 2 }).at(-1)).toEqual(["last", 2]);
  expect(follow("if", ["then"], { first: 1, then: 2 }).at(-1)).toEqual(["last", undefined]);
  expect(follow("if", ["then"], { first: 1 }).at(-1)).toEqual(["last", 1]);
});

test("of branches at once the one that drives the robot says where it stands", () => {
  expect(follow("parallel", ["a", "b"], { first: 1, b: 2 }).at(-1)).toEqual(["last", 2]);
  expect(follow("parallel", ["a", "b"], { first: 1, a: 2, b: 3 }).at(-1)).toEqual(["last", undefined]);
});
