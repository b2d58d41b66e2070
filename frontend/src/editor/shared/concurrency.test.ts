/** People who join, move, wrap and delete steps at the same time: all see the same program, and no step is lost. */
import { expect, test } from "vitest";
import * as Y from "yjs";
import { expandCall, wrapInFunction } from "../edits/calls";
import { clip, paste } from "../edits/clipping";
import type { Decision, Edit } from "../edits/edits";
import { liftOut, moveIn, swapBranches, takeApart } from "../edits/branches";
import {
  addStep,
  deleteSteps,
  disconnect,
  endOfBranch,
  joinDrafts,
  joinSteps,
  moveStep,
  shiftStep,
} from "../edits/joints";
import { readDocument } from "./snapshot";
import { branchesOf, PROGRAM, readTree, type BranchRef } from "@/program/document/tree";
import type { ProgramDocument, StepKind } from "@/program/document/document";
import { writeEdit } from "./writer";

type Random = () => number;

/** Numbers between 0 and 1, the same for the same seed. */
function randomFrom(seed: number): Random {
  let state = seed * 2654435761 + 1;
  return () => {
    state = (Math.imul(state ^ (state >>> 15), state | 1) + 0x6d2b79f5) | 0;
    return ((state ^ (state >>> 14)) >>> 0) / 4294967296;
  };
}

function choose<T>(random: Random, items: readonly T[]): T {
  return items[Math.floor(random() * items.length)] as T;
}

const KINDS: readonly StepKind[] = ["while", "if", "try", "parallel", "wait", "wait", "on_event", "comment"];

class Person {
  readonly doc = new Y.Doc();
  /** Steps that somebody made and that nobody has removed. */
  readonly #alive: Set<string>;
  #count = 0;

  constructor(number: number, alive: Set<string>) {
    this.doc.clientID = number;
    this.#alive = alive;
  }

  makeId = (): string => `p${this.doc.clientID}n${(this.#count += 1)}`;

  act(random: Random): void {
    const edits = this.#gesture(readDocument(this.doc), random);
    for (const edit of edits) {
      if (edit.do === "add_step") this.#alive.add(edit.id);
      if (edit.do === "remove_step") this.#alive.delete(edit.id);
    }
    this.doc.transact(() => {
      for (const edit of edits) writeEdit(this.doc, edit);
    });
  }

  #gesture(document: ProgramDocument, random: Random): readonly Edit[] {
    const ids = Object.keys(document.steps);
    if (ids.length < 3 || random() < 0.15) return this.#add(document, random);
    const [one, other] = [choose(random, ids), choose(random, ids)];
    const decide = choose<() => Decision | readonly Edit[]>(random, [
      () => joinSteps(document, one, other),
      () => moveStep(document, one, branchIn(document, random, other), null),
      () => moveStep(document, one, branchIn(document, random, other), null),
      () => shiftStep(document, one, random() < 0.5 ? 1 : -1),
      () => liftOut(document, [one]),
      () => moveIn(document, [one]),
      () => swapBranches(document, one),
      () => takeApart(document, one),
      () => disconnect(document, [one]),
      () => joinDrafts(document, [one]),
      () => wrapInFunction(document, [one], { functionId: `f${this.makeId()}`, callId: this.makeId(), name: "f" }),
      () => expandCall(document, one, this.makeId),
      () => paste(document, clip(document, [one]), endOfBranch(document, PROGRAM), this.makeId).edits,
      () => deleteSteps(document, [one]),
    ])();
    if ("refused" in decide) return [];
    return "edits" in decide ? decide.edits : decide;
  }

  #add(document: ProgramDocument, random: Random): readonly Edit[] {
    const parent = choose(random, ["program", ...Object.keys(document.steps)]);
    const fresh = { id: this.makeId(), kind: choose(random, KINDS), pos: [0, 0], params: {} } as const;
    return addStep(document, branchIn(document, random, parent), fresh);
  }
}

function branchIn(document: ProgramDocument, random: Random, parent: string): BranchRef {
  const step = document.steps[parent];
  const branches = step ? branchesOf(step) : [];
  return branches.length > 0 ? { parent, branch: choose(random, branches) } : PROGRAM;
}

/** Some people work, hear of each other now and then, and at last hear everything, each in another order. */
function session(seed: number): { people: Person[]; alive: Set<string> } {
  const random = randomFrom(seed);
  const alive = new Set<string>();
  const people = Array.from({ length: 2 + (seed % 3) }, (_, index) => new Person(index + 1, alive));
  const updates: Uint8Array[] = [];
  for (const { doc } of people) doc.on("update", (update: Uint8Array) => updates.push(update));
  for (let moment = 0; moment < 24; moment += 1) {
    const person = choose(random, people);
    person.act(random);
    const listener = choose(random, people);
    if (random() < 0.4) Y.applyUpdate(listener.doc, Y.encodeStateAsUpdate(person.doc));
  }
  for (const { doc } of people)
    for (const update of [...updates].sort(() => random() - 0.5)) Y.applyUpdate(doc, update);
  return { people, alive };
}

/** All that people see of the order. */
function seen(document: ProgramDocument): unknown {
  const tree = readTree(document);
  const depths = [...tree.reading, ...tree.loose].map((id) => [id, tree.depth(id)]);
  return { depths, drafts: tree.drafts, steps: document.steps, functions: document.functions };
}

test.each(Array.from({ length: 60 }, (_, seed) => seed + 1))("session %i ends alike for all", (seed) => {
  const { people, alive } = session(seed);
  const [first, ...others] = people.map(({ doc }) => readDocument(doc));
  if (!first) throw new Error("nobody was there");
  for (const other of others) expect(seen(other)).toEqual(seen(first));
  const { reading, loose } = readTree(first);
  const comments = Object.keys(first.steps).filter((id) => first.steps[id]?.kind === "comment");
  expect([...reading, ...loose, ...comments].sort()).toEqual(Object.keys(first.steps).sort());
  expect([...alive].filter((id) => !(id in first.steps))).toEqual([]);
});

test("two frames moved into each other: one is a draft with the other in it, for everybody", () => {
  const alive = new Set<string>();
  const [one, other] = [new Person(1, alive), new Person(2, alive)];
  const frames = ["a", "b"].map((id): Edit => ({
    do: "add_step",
    id,
    step: { kind: "while", place: ["program", "body", id], pos: [0, 0], params: {} },
  }));
  for (const edit of frames) writeEdit(one.doc, edit);
  Y.applyUpdate(other.doc, Y.encodeStateAsUpdate(one.doc));
  const into = (person: Person, id: string, parent: string) => {
    const decision = moveStep(readDocument(person.doc), id, { parent, branch: "body" }, null);
    if ("edits" in decision) for (const edit of decision.edits) writeEdit(person.doc, edit);
  };
  into(one, "a", "b");
  into(other, "b", "a");
  Y.applyUpdate(one.doc, Y.encodeStateAsUpdate(other.doc));
  Y.applyUpdate(other.doc, Y.encodeStateAsUpdate(one.doc));
  for (const { doc } of [one, other]) {
    const tree = readTree(readDocument(doc));
    expect([tree.drafts, tree.children("a", "body"), tree.reading]).toEqual([["a"], ["b"], []]);
  }
});
