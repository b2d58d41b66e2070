import { expect, test } from "vitest";
import type { Program, RunSummary, User } from "@/api/types";
import { demoSteps, ownProgram } from "./demoSteps";

const ada: User = { id: 1, name: "Ada", initials: "A", email: "ada@vipo.example" };
const program = (id: string, by: string | null, edited_at: string, kinds = ["pick_and_drop"]) =>
  ({
    id,
    edited_by: by ? { id: by === "Ada" ? ada.id : 2, name: by, initials: "" } : null,
    edited_at,
    kinds,
  }) as unknown as Program;
const run = (by: string) => ({ started_by: { name: by, initials: "" } }) as unknown as RunSummary;
const NOTHING = { user: ada, programs: [], runs: [], lookedAround: false, simulated: false };
const done = (known: Parameters<typeof demoSteps>[0]) =>
  demoSteps(known)
    .filter((step) => step.done)
    .map((step) => step.key);

test("nothing is ticked before anything was done", () => {
  expect(demoSteps(NOTHING).map((step) => step.key)).toEqual(["look", "draw", "simulate", "run"]);
  expect(done(NOTHING)).toEqual([]);
});

test("only one's own drawing and runs count", () => {
  const others = { ...NOTHING, programs: [program("a", "Ben", "2026-01-01")], runs: [run("Ben")] };
  expect(done(others)).toEqual([]);
  const own = { ...NOTHING, programs: [program("a", "Ada", "2026-01-01")], runs: [run("Ada")] };
  expect(done(own)).toEqual(["draw", "run"]);
});

test("a program of somebody of the same name is not one's own", () => {
  const other = { ...program("a", "Ada", "2026-01-01"), edited_by: { id: 9, name: "Ada", initials: "A" } };
  expect(ownProgram(ada, [other])).toBeUndefined();
});

test("looking around and simulating are ticked by themselves", () => {
  expect(done({ ...NOTHING, lookedAround: true, simulated: true })).toEqual(["look", "simulate"]);
});

test("one's own program is the one drawn last that has a Pick-and-Drop", () => {
  const programs = [
    program("old", "Ada", "2026-01-01"),
    program("new", "Ada", "2026-02-01"),
    program("newest", "Ada", "2026-03-01", ["wait"]),
    program("seeded", null, "2026-04-01"),
  ];
  expect(ownProgram(ada, programs)?.id).toBe("new");
});
