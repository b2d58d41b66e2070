/** Programs that the server is tested with, too: both must read the same steps in the same order, and both can name them. */
import { expect, test } from "vitest";
import { chipText, plainText } from "./words/stepWords";
import { surroundingsOf, type Surroundings } from "./surroundings";
import { ancestors, readTree } from "./document/tree";
import type { ProgramDocument } from "./document/document";

interface Case {
  readonly document: ProgramDocument;
  readonly expected?: {
    readonly order: readonly string[];
    readonly depth: Readonly<Record<string, number>>;
    readonly numbers: Readonly<Record<string, string>>;
  };
}

const FILES = {
  ...import.meta.glob<Case>("../../../tests/cases/constructs/*.json", { eager: true, import: "default" }),
  ...import.meta.glob<Case>("../../../tests/cases/checks/*.json", { eager: true, import: "default" }),
  ...import.meta.glob<Case>("../../../tests/fixtures/programs/*.json", { eager: true, import: "default" }),
  ...import.meta.glob<Case>("../../../examples/**/*.json", { eager: true, import: "default" }),
};
const cases = Object.entries(FILES)
  // some cases of the checks are scripts
  .filter(([, content]) => content.document?.steps !== undefined)
  .map(([path, content]) => [path.split("/").at(-1) ?? "", content] as const);
const compiled = cases.flatMap(([name, { document, expected }]) =>
  expected ? [[name, { document, expected }] as const] : [],
);

const NOWHERE: Surroundings = surroundingsOf([], []);
const t = (key: string) => key;

/** Comments are no steps, here as there. */
function stepsOf(document: ProgramDocument): string[] {
  return Object.keys(document.steps).filter((id) => document.steps[id]?.kind !== "comment");
}

/** The steps of the program and of each function by themselves: a function stands where each reader shows it. */
function byScope(document: ProgramDocument, order: readonly string[], depth: (id: string) => number) {
  const scopes: Record<string, [string, number][]> = {};
  for (const id of order) {
    const scope = ancestors(document, id).at(-1) ?? "";
    const steps = (scopes[scope] ??= []);
    steps.push([id, depth(id)]);
  }
  return Object.fromEntries(
    Object.entries(scopes).map(([scope, steps]) => {
      const top = document.functions[scope] ? Math.min(...steps.map(([, deep]) => deep)) : 0;
      return [scope, steps.map(([id, deep]) => `${id} ${deep - top}`)];
    }),
  );
}

test.each(compiled)("%s is read in the order that the server compiles it", (_name, { document, expected }) => {
  const { reading, loose, depth } = readTree(document);
  const compiledDepth = (id: string) => expected.depth[id] ?? -1;
  expect(byScope(document, [...reading, ...loose], depth)).toEqual(byScope(document, expected.order, compiledDepth));
});

test.each(compiled)("what has a number in %s is no draft", (_name, { document, expected }) => {
  expect([...readTree(document).reading].sort()).toEqual(Object.keys(expected.numbers).sort());
});

test.each(cases)("no step of %s is lost", (_name, { document }) => {
  const { reading, loose } = readTree(document);
  expect([...reading, ...loose].sort()).toEqual(stepsOf(document).sort());
});

test.each(cases)("every step of %s says something on the map", (_name, { document }) => {
  const speaker = { document, surroundings: NOWHERE, t };
  const unsaid = stepsOf(document).filter((id) => {
    const step = document.steps[id];
    return !step || plainText(chipText(step, speaker)).trim() === "";
  });
  expect(unsaid).toEqual([]);
});

test("there is a good number of cases", () => {
  expect(compiled.length).toBeGreaterThanOrEqual(120);
  expect(cases.length).toBeGreaterThanOrEqual(280);
});
