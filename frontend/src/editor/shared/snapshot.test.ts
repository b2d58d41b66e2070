/** The cases are the server's own: browsers must read the same of them, and draw whatever is left. */
import { expect, test } from "vitest";
import * as Y from "yjs";
import { readDocument } from "./snapshot";
import cases from "../../../../tests/cases/odd_documents.json";
import { buildScene } from "@/program/scene/scene";
import { surroundingsOf } from "@/program/surroundings";
import { chipText, plainText } from "@/program/words/stepWords";
import type { ProgramDocument } from "@/program/document/document";
import { RECORDS, wellFormed } from "@/program/document/wellFormed";

type Json = Readonly<Record<string, unknown>>;
interface Case {
  readonly given: Json;
  readonly read: Readonly<Record<(typeof RECORDS)[number] | "steps", Readonly<Record<string, Json>>>> & {
    readonly start_pos: unknown;
  };
}

const CASES = (cases as unknown as Case[]).map((each, number) => [number, each] as const);
const NOWHERE = surroundingsOf([], []);
const t = (key: string) => key;

const OF_STEPS = ["kind", "place", "pos", "params"];

/** Without what screens are given where nobody wrote it, without nulls, and of a step without what no step has. */
function written(part: Json, like: Json, root: string): Json {
  const counts = (field: string) => (like[field] ?? null) !== null && (root !== "steps" || OF_STEPS.includes(field));
  return Object.fromEntries(Object.entries(part).filter(([field]) => counts(field)));
}

function shared(document: Json): Y.Doc {
  const doc = new Y.Doc();
  for (const root of ["steps", ...RECORDS]) {
    const given = document[root];
    if (typeof given !== "object" || given === null || Array.isArray(given)) continue;
    for (const [id, part] of Object.entries(given)) doc.getMap(root).set(id, part);
  }
  doc.getMap("meta").set("start_pos", document.start_pos ?? null);
  return doc;
}

test.each(CASES)("case %i is read as the server reads it", (_number, { given, read }) => {
  const found = wellFormed(given);
  expect(found.start_pos).toEqual(read.start_pos ?? null);
  for (const root of ["steps", ...RECORDS] as const) {
    const parts = found[root] as Readonly<Record<string, Json>>;
    expect(Object.keys(parts).sort()).toEqual(Object.keys(read[root]).sort());
    for (const [id, part] of Object.entries(read[root]))
      expect(written(parts[id] ?? {}, part, root)).toEqual(written(part, part, root));
  }
});

test.each(CASES)("case %i is drawn and put into words, shared or not", (_number, { given }) => {
  for (const document of [wellFormed(given), readDocument(shared(given))]) draw(document);
});

function draw(document: ProgramDocument): void {
  const measure = (text: string) => text.length * 7;
  const site = { document, surroundings: NOWHERE, t };
  buildScene({ ...site, compiled: null, floor: null, routes: () => null, collapsed: new Set(), measure });
  for (const step of Object.values(document.steps)) expect(typeof plainText(chipText(step, site))).toBe("string");
}

test("a part further away than any site is drawn where it can be", () => {
  const step = { kind: "wait", place: ["program", "body", "V"], pos: [2 ** 53, -1], params: {} };
  expect(wellFormed({ steps: { s: step } }).steps.s?.pos).toBeNull();
});
