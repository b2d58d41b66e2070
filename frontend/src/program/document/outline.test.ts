/** Every file in tests/cases/outline, which the server reads, too: both must find the same program. */
import { expect, test } from "vitest";
import { branchesOf, makeOutline } from "./outline";
import { readTree } from "./tree";
import type { ProgramDocument } from "./document";

interface Case {
  readonly what: string;
  readonly document: ProgramDocument;
  readonly expected: {
    readonly children: readonly [string, string, readonly string[]][];
    readonly drafts: readonly string[];
    readonly unknown: readonly string[];
  };
}

const files = import.meta.glob<Case>("../../../../tests/cases/outline/*.json", { eager: true, import: "default" });
const cases = Object.entries(files).map(([path, content]) => [path.split("/").at(-1) ?? "", content] as const);

/** Every branch that a step, the program or a function has, with what stands in it. */
function branchesWithSteps(document: ProgramDocument): Set<string> {
  const { children } = makeOutline(document);
  const steps = Object.entries(document.steps).flatMap(([id, step]) => branchesOf(step).map((name) => [id, name]));
  const tops = ["program", ...Object.keys(document.functions)].map((id) => [id, "body"]);
  const all = [...steps, ...tops, ["program", "events"]].map(([id = "", name = ""]) => [id, name, children(id, name)]);
  return new Set(all.filter(([, , ids]) => ids?.length).map((each) => JSON.stringify(each)));
}

test.each(cases)("%s is read as it says", (_name, { document, expected }) => {
  const { drafts, unknown } = makeOutline(document);
  expect({ drafts, unknown }).toEqual({ drafts: expected.drafts, unknown: expected.unknown });
  expect(branchesWithSteps(document)).toEqual(new Set(expected.children.map((each) => JSON.stringify(each))));
});

test.each(cases)("no step of %s is lost or shown twice", (_name, { document }) => {
  const { reading, loose } = readTree(document);
  const comments = Object.keys(document.steps).filter((id) => document.steps[id]?.kind === "comment");
  expect([...reading, ...loose, ...comments].sort()).toEqual(Object.keys(document.steps).sort());
});

test("there is a good number of cases", () => {
  expect(cases.length).toBeGreaterThanOrEqual(40);
});
