/** The cases are the server's own: what it sends must make here what it has there. */
import { expect, test } from "vitest";
import type { Compiled } from "@/api/types";
import cases from "../../../tests/cases/compiled_patches.json";
import { applyPatch } from "./compiledPatch";
import type { CompiledPatch } from "./compiledPatch";

interface Case {
  readonly name: string;
  readonly before: Compiled;
  readonly patch: CompiledPatch;
  readonly after: Compiled;
}

test.each((cases as unknown as Case[]).map((each) => [each.name, each] as const))(
  "%s: the change makes the new form of the old one",
  (_name, { before, patch, after }) => {
    expect(applyPatch(before, patch)).toEqual(after);
  },
);

test("a change of another form is not applied", () => {
  const [first] = cases as unknown as Case[];
  expect(first && applyPatch(first.after, first.patch)).toBeNull();
});
