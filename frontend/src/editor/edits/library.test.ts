import { expect, test } from "vitest";
import { applyEdits } from "./edits";
import { alreadyImported, importFunction, replaceFunction, type CutOut } from "./library";
import { readTree } from "@/program/document/tree";
import { EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";

const cut: CutOut = {
  id: "f",
  function: { name: "mixPaint", parameters: [] },
  functions: { g: { name: "rinse", parameters: [] } },
  steps: {
    loop: { kind: "while", place: ["f", "body", "A"], params: {} },
    inside: { kind: "call", place: ["loop", "body", "A"], params: { function: "g", args: {} } },
    rinse: { kind: "wait", place: ["g", "body", "A"], params: { seconds: 1 } },
  },
};

test("an imported function has new ids throughout and knows where it is from", () => {
  let count = 0;
  const { edits, functionId } = importFunction(
    EMPTY_DOCUMENT,
    cut,
    { library: "lib", version: 3 },
    () => `n${(count += 1)}`,
  );
  const document = applyEdits(EMPTY_DOCUMENT, edits);
  const tree = readTree(document);
  const [loop] = tree.children(functionId, "body");
  const [call] = tree.children(loop ?? "", "body");
  const called = String(document.steps[call ?? ""]?.params.function);
  expect(document.functions[functionId]?.source).toEqual({ library: "lib", version: 3 });
  expect(document.functions[called]?.name).toBe("rinse");
  expect(tree.children(called, "body")).toHaveLength(1);
  expect(tree.drafts).toEqual([]);
  expect(alreadyImported(document, "lib", 3)).toBe(functionId);
  expect(alreadyImported(document, "lib", 4)).toBeNull();
});

test("another version takes the place of the function, and its calls stay", () => {
  const document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    functions: { mix: { name: "mixPaint", parameters: [], source: { library: "lib", version: 2 } } },
    steps: {
      old: { kind: "try", place: ["mix", "body", "A"], params: {} },
      inner: { kind: "wait", place: ["old", "body", "A"], params: { duration: 1 } },
      call: { kind: "call", place: ["program", "body", "A"], params: { function: "mix", args: {} } },
    },
  };
  let count = 0;
  const edits = replaceFunction(document, "mix", cut, { library: "lib", version: 3 }, () => `n${(count += 1)}`);
  const after = applyEdits(document, edits);
  expect(after.functions.mix?.source).toEqual({ library: "lib", version: 3 });
  expect(after.steps.old).toBeUndefined();
  expect(after.steps.inner).toBeUndefined();
  expect(readTree(after).children("mix", "body")).toHaveLength(1);
  expect(after.steps.call).toEqual(document.steps.call);
  expect(replaceFunction(document, "gone", cut, { library: "lib", version: 3 }, () => "n")).toEqual([]);
});

test("roles and zones come in with the function; what is there under the same name and is another stays", () => {
  const zone = { name: "Wet", rule: "keep_out" as const, points: [] };
  const crew: CutOut = {
    ...cut,
    functions: {},
    steps: {
      go: { kind: "move", place: ["f", "body", "A"], params: { role: "porter", to: { at: { role: "lifter" } } } },
      call: { kind: "call", place: ["f", "body", "C"], params: { function: "f", args: { role: "porter" } } },
      clean: { kind: "cover", place: ["f", "body", "B"], params: { role: "robot", zone: "z" } },
    },
    roles: { porter: { name: "Porter", can: ["pick"] }, lifter: { name: "Lifter", can: ["lift"] } },
    zones: { z: zone },
  };
  let count = 0;
  const makeId = () => `n${(count += 1)}`;
  const document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    roles: { porter: { name: "Doorkeeper", can: [] }, lifter: { name: "Lifter", can: ["lift"] } },
  };
  const after = applyEdits(document, importFunction(document, crew, { library: "lib", version: 1 }, makeId).edits);
  const [go] = Object.values(after.steps).filter((step) => step.kind === "move");
  const porter = String(go?.params.role);
  expect(after.roles.porter).toEqual({ name: "Doorkeeper", can: [] });
  expect(after.roles[porter]).toEqual({ name: "Porter", can: ["pick"] });
  expect(go?.params.to).toEqual({ at: { role: "lifter" } });
  const [call] = Object.values(after.steps).filter((step) => step.kind === "call");
  expect(call?.params.args).toEqual({ role: "porter" });
  expect(Object.keys(after.roles)).toHaveLength(3);
  expect(after.zones).toEqual({ z: zone });
});

test("roles and zones that the document has just so are taken as they are, in whatever order their keys come", () => {
  const crew: CutOut = {
    ...cut,
    functions: {},
    steps: { clean: { kind: "cover", place: ["f", "body", "A"], params: { role: "r", zone: "z" } } },
    roles: { r: { can: ["pick", "drop"], name: "Carrier" } },
    zones: { z: { rule: "slow", name: "Wet", speed_m_s: 0.3, points: [[0, 0]] } },
  };
  const document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    roles: { r: { name: "Carrier", can: ["pick", "drop"] } },
    zones: { z: { name: "Wet", points: [[0, 0]], rule: "slow", speed_m_s: 0.3 } },
  };
  let count = 0;
  const { edits } = importFunction(document, crew, { library: "lib", version: 2 }, () => `n${(count += 1)}`);
  const after = applyEdits(document, edits);
  expect([after.roles, after.zones]).toEqual([document.roles, document.zones]);
  expect(Object.values(after.steps).map(({ params }) => params)).toEqual([{ role: "r", zone: "z" }]);
});

test("a role that names itself in its condition does so under its new id, too", () => {
  const where = (role: string, above: number) => ({ op: ">", args: [{ property: [{ role }, "battery"] }, above] });
  const carrier = (role: string, above: number) => ({ name: "Carrier", can: ["move"], where: where(role, above) });
  const crew = {
    ...cut,
    functions: {},
    steps: { go: { kind: "move", place: ["f", "body", "A"], params: { role: "r", to: { place: "dock" } } } },
    roles: { r: carrier("r", 30) },
  } as unknown as CutOut;
  const document = { ...EMPTY_DOCUMENT, roles: { r: carrier("r", 50) } } as unknown as ProgramDocument;
  let count = 0;
  const { edits } = importFunction(document, crew, { library: "lib", version: 2 }, () => `n${(count += 1)}`);
  const after = applyEdits(document, edits);
  const [go] = Object.values(after.steps);
  const role = String(go?.params.role);
  expect(role).not.toBe("r");
  expect(after.roles).toEqual({ r: carrier("r", 50), [role]: carrier(role, 30) });
});

test("functions that came with the former version go with it, but for those that something else calls", () => {
  const call = (parent: string, called: string) => ({
    kind: "call",
    place: [parent, "body", "A"] as const,
    params: { function: called, args: {} },
  });
  const wait = (parent: string) => ({ kind: "wait", place: [parent, "body", "B"] as const, params: { duration: 1 } });
  const named = (name: string) => ({ name, parameters: [] });
  const document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    functions: { mix: named("mixPaint"), old: named("rinse"), deep: named("drain"), own: named("myOwn") },
    steps: {
      main: call("program", "mix"),
      body: call("mix", "old"),
      more: { ...call("mix", "own"), place: ["mix", "body", "B"] },
      rinse: wait("old"),
      down: call("old", "deep"),
      drain: wait("deep"),
      mine: wait("own"),
    },
  };
  const next: CutOut = {
    ...cut,
    functions: { g: named("rinse"), h: named("drain") },
    steps: { ...cut.steps, drained: call("g", "h"), idle: wait("h") },
  };
  const take = (from: ProgramDocument) => {
    let count = 0;
    const source = { library: "lib", version: 3 };
    return applyEdits(
      from,
      replaceFunction(from, "mix", next, source, () => `n${(count += 1)}`),
    );
  };
  const namesIn = (after: ProgramDocument) => Object.values(after.functions).map(({ name }) => name);
  const after = take(document);
  expect(namesIn(after).sort()).toEqual(["drain", "mixPaint", "myOwn", "rinse"]);
  expect([after.steps.rinse, after.steps.down, after.steps.drain]).toEqual([undefined, undefined, undefined]);
  expect(after.steps.mine).toEqual(document.steps.mine);
  // A draft counts as well.
  const draft = { ...call("program", "deep"), place: null };
  const kept = take({ ...document, steps: { ...document.steps, draft } });
  expect(namesIn(kept).sort()).toEqual(["drain", "drain", "mixPaint", "myOwn", "rinse"]);
  expect([kept.functions.old, kept.steps.drain]).toEqual([undefined, document.steps.drain]);
  // What calls itself, or is called by what its own parts call, stands in nobody's way.
  const again = { ...call("deep", "old"), place: ["deep", "body", "C"] as const };
  expect(namesIn(take({ ...document, steps: { ...document.steps, again } })).sort()).toEqual(namesIn(after).sort());
});

test("functions that the new version renamed or dropped go, and one's own of a new name stays", () => {
  const call = (parent: string, called: string, order: string) => ({
    kind: "call",
    place: [parent, "body", order] as const,
    params: { function: called, args: {} },
  });
  const wait = (parent: string) => ({ kind: "wait", place: [parent, "body", "A"] as const, params: { duration: 1 } });
  const named = (name: string) => ({ name, parameters: [] });
  const document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    functions: { mix: named("mixPaint"), r: named("soak"), d: named("drain"), o: named("rinse") },
    steps: {
      main: call("program", "mix", "A"),
      a: call("mix", "r", "A"),
      b: call("mix", "d", "B"),
      c: call("mix", "o", "C"),
      soaks: wait("r"),
      drains: wait("d"),
      mine: wait("o"),
    },
  };
  const former: CutOut = { ...cut, functions: { r: named("soak"), d: named("drain") } };
  let count = 0;
  const source = { library: "lib", version: 3 };
  const makeId = () => `n${(count += 1)}`;
  const after = applyEdits(document, replaceFunction(document, "mix", cut, source, makeId, former));
  expect(
    Object.values(after.functions)
      .map(({ name }) => name)
      .sort(),
  ).toEqual(["mixPaint", "rinse", "rinse"]);
  expect([after.steps.soaks, after.steps.drains, after.steps.mine]).toEqual([
    undefined,
    undefined,
    document.steps.mine,
  ]);
});
