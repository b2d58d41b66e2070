import { expect, test } from "vitest";
import {
  EMPTY_DOCUMENT,
  type ProgramDocument,
  type Role,
  type Step,
  type Value,
  type Zone,
} from "@/program/document/document";
import { PROGRAM } from "@/program/document/tree";
import { roleOfStep } from "@/program/operation";
import { clip, clippingFromText, clippingToText, paste } from "./clipping";
import { applyEdits } from "./edits";
import { endOfBranch } from "./joints";

const at = (kind: string, place: Step["place"], params: Step["params"]): Step => ({
  kind,
  place,
  pos: [1, -1],
  params,
});
const first: Step["place"] = ["program", "body", "A"];
const wait = (until: unknown, place: Step["place"] = ["program", "body", "B"]) => at("wait", place, { until });

/** The target with steps of the source in it, taken through text, and what the copies are told. */
function pasted(source: ProgramDocument, ids: readonly string[], target: ProgramDocument, here = "b") {
  const clipping = clippingFromText(clippingToText(clip(source, ids, "a")));
  if (!clipping) throw new Error("not read");
  let count = 0;
  const makeId = () => `new${Object.keys(target.steps).length}_${(count += 1)}`;
  const { edits, added } = paste(target, clipping, endOfBranch(target, PROGRAM), makeId, here);
  const document = applyEdits(target, edits);
  return { document, params: added.map((id) => document.steps[id]?.params) };
}

const bound: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  roles: { robot: { name: "Robot", device: "robot01" } },
  steps: {
    go: at("move", first, { to: { place: "dock" } }),
    honk: at("operate", ["program", "body", "B"], {
      device: { role: "robot" },
      method: "honk",
      args: { role: "robot" },
    }),
    full: wait({ op: ">", args: [{ property: [{ role: "robot" }, "battery"] }, 30] }, ["program", "body", "C"]),
  },
};
const driving: ProgramDocument = { ...EMPTY_DOCUMENT, steps: { t: at("move", first, { to: { place: "lab" } }) } };

test("pasted steps keep their robot, and those of the program keep theirs", () => {
  const { document, params } = pasted(bound, ["go", "honk", "full"], driving);
  const [id = "", ...others] = Object.keys(document.roles);
  expect([id === "robot", others]).toEqual([false, []]);
  expect(document.roles[id]).toEqual(bound.roles.robot);
  expect(document.steps.t).toEqual(driving.steps.t);
  expect(params).toEqual([
    { role: id, to: { place: "dock" } },
    { device: { role: id }, method: "honk", args: { role: "robot" } },
    { until: { op: ">", args: [{ property: [{ role: id }, "battery"] }, 30] } },
  ]);
  const again = pasted(bound, ["go"], document);
  expect(again.document.roles).toEqual(document.roles);
  expect(again.params).toEqual([{ role: id, to: { place: "dock" } }]);
});

test("a program whose steps have no robot yet takes the pasted one's as its own", () => {
  const { document, params } = pasted(bound, ["go"], EMPTY_DOCUMENT);
  expect(document.roles).toEqual(bound.roles);
  expect(params).toEqual([{ to: { place: "dock" } }]);
  expect(pasted(bound, ["go"], { ...bound, roles: {} }, "a").document.roles).toEqual({});
});

/** The robots that drive the steps of a program, by the steps' ids. */
function robotsOf({ roles, steps }: ProgramDocument) {
  return Object.fromEntries(Object.entries(steps).map(([id, step]) => [id, roles[roleOfStep(step) ?? ""]?.device]));
}

const byRobot01: Role = { name: "Robot", device: "robot01" };
const mover: Role = { name: "Mover", can: ["move"] };
const onLoad: Role = {
  name: "On load",
  can: [],
  where: { op: ">", args: [{ property: [{ role: "r1" }, "load"] }, 0] },
};

test.each<[what: string, own: ProgramDocument["roles"], after: string[]]>([
  ["a role that is not bound", { r1: mover }, ["r1", "new"]],
  ["a role that is bound to another robot", { r1: { name: "Robot", device: "robot02" } }, ["r1", "new"]],
  ["a role that any robot may have", { r1: { name: "Robot", can: [] } }, ["r1", "new"]],
  ["the role with another name", { r1: { name: "First", device: "robot01" } }, ["r1"]],
  ["a role of the same robot under another id", { r1: mover, r2: byRobot01 }, ["r1", "r2"]],
  ["nothing, though steps name it", {}, ["new"]],
])("a pasted step drives its robot where another program has under its role's id %s", (_, own, after) => {
  for (const role of ["robot", "r1"]) {
    const as = (id: string) => (id === "r1" ? role : id);
    const roles = Object.fromEntries(Object.entries(own).map(([id, value]) => [as(id), value]));
    const drive = (place: string) => at("move", first, { ...(role === "robot" ? {} : { role }), to: { place } });
    const source = { ...EMPTY_DOCUMENT, roles: { [role]: byRobot01 }, steps: { go: drive("dock") } };
    const target = { ...EMPTY_DOCUMENT, roles, steps: { t: drive("lab") } };
    const { document } = pasted(source, ["go"], target);
    expect(robotsOf(document)).toEqual({ ...robotsOf(target), new1_1: "robot01" });
    expect(document.steps.t).toEqual(target.steps.t);
    expect(Object.keys(document.roles).map((id) => (id.startsWith("new") ? "new" : id))).toEqual(after.map(as));
    expect(pasted(source, ["go"], document).document.roles).toEqual(document.roles);
  }
});

test("steps pasted into a copy of their program, which has the same ids, drive their robot whatever it has been bound to", () => {
  const copy = { ...bound, roles: { robot: { name: "Robot", device: "robot02" } } };
  const { document } = pasted(bound, ["go"], copy);
  expect(robotsOf(document)).toMatchObject({ go: "robot02", honk: "robot02", new3_1: "robot01" });
  expect(pasted(bound, ["go"], bound).document.roles).toEqual(bound.roles);
});

test("in their own program pasted steps have their role as it is now", () => {
  const now = { ...bound, roles: { robot: { name: "Robot", device: "robot02" } } };
  const { document } = pasted(bound, ["go"], now, "a");
  expect([document.roles, robotsOf(document).new3_1]).toEqual([now.roles, "robot02"]);
});

test("a role that is not bound comes in once, also where its condition names it", () => {
  const source = (role: Role) => ({
    ...EMPTY_DOCUMENT,
    roles: { r1: role },
    steps: { go: at("move", first, { role: "r1", to: { place: "dock" } }) },
  });
  for (const role of [mover, onLoad]) {
    const { document } = pasted(source(role), ["go"], source({ name: "Carrier", can: ["pick"] }));
    expect(Object.keys(document.roles)).toHaveLength(2);
    expect(pasted(source(role), ["go"], document).document.roles).toEqual(document.roles);
  }
});

test("the condition of a role that gets another id names the role itself", () => {
  const where = (role: string): Value => ({ op: ">", args: [{ property: [{ role }, "battery"] }, 30] });
  const choosing = { ...bound, roles: { robot: { name: "Robot", can: [], where: where("robot") } } };
  const { document } = pasted(choosing, ["go"], driving);
  const [id = ""] = Object.keys(document.roles);
  expect(document.roles[id]?.where).toEqual(where(id));
});

const hall: Zone = { name: "Hall", rule: "keep_out", points: [[0, 0], [4, 0], [4, 4]] }; // prettier-ignore
const inHall = { op: "in", args: [{ at: { role: "carrier" } }, { zone: "z1" }] };
const cleaning: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  roles: { carrier: { name: "Carrier", can: ["pick"] } },
  functions: { clean: { name: "clean", parameters: [] } },
  zones: { z1: hall, z2: { ...hall, name: "Yard" }, z3: hall },
  steps: {
    cover: at("cover", first, { role: "robot", zone: "z1" }),
    seen: wait(inHall),
    call: at("call", ["program", "body", "C"], { function: "clean", args: { zone: "z1" } }),
    inner: at("cover", ["clean", "body", "A"], { role: "robot", zone: "z2" }),
  },
};

test("zones and roles come along that steps, their conditions and their functions name, and no others", () => {
  const { document, params } = pasted(cleaning, ["cover", "seen", "call"], EMPTY_DOCUMENT);
  expect(document.zones).toEqual({ z1: cleaning.zones.z1, z2: cleaning.zones.z2 });
  expect(document.roles).toEqual(cleaning.roles);
  expect(params.map((each) => each?.zone ?? each?.until)).toEqual(["z1", inHall, undefined]);
  const { cover, inner } = cleaning.steps;
  const known = { ...cleaning, steps: { cover, inner } as ProgramDocument["steps"] };
  expect(pasted(cleaning, ["call"], known).document.functions).toEqual(cleaning.functions);
  const open = { ...EMPTY_DOCUMENT, functions: cleaning.functions };
  expect(pasted(cleaning, ["call"], open, "a").document.zones).toEqual({});
});

test("a zone comes under another id where another program has that id for another zone, once", () => {
  const target = { ...EMPTY_DOCUMENT, zones: { z1: { ...hall, name: "Store" } } };
  const { document, params } = pasted(cleaning, ["cover", "seen", "call"], target);
  const id = String(params[0]?.zone);
  expect(document.zones).toEqual({ ...target.zones, [id]: hall, z2: cleaning.zones.z2 });
  expect(params[1]?.until).toEqual({ op: "in", args: [{ at: { role: "carrier" } }, { zone: id }] });
  expect(params[2]?.args).toEqual({ zone: "z1" });
  const again = pasted(cleaning, ["cover"], document);
  expect([again.document.zones, again.params[0]?.zone]).toEqual([document.zones, id]);
});

test("a zone is not taken for another one that only its id is left of, and stays where it is alike", () => {
  const dangling = { ...cleaning, zones: {}, functions: {}, steps: { t: at("cover", first, { zone: "z1" }) } };
  const { document, params } = pasted(cleaning, ["cover"], dangling);
  const id = String(params[0]?.zone);
  expect([id === "z1", document.zones]).toEqual([false, { [id]: hall }]);
  const alike = pasted(cleaning, ["cover"], { ...EMPTY_DOCUMENT, zones: { z3: hall, z1: hall } });
  expect([alike.document.zones, alike.params[0]?.zone]).toEqual([{ z3: hall, z1: hall }, "z1"]);
});

/** A function that calls another one, which drives the usual robot. */
const nested: ProgramDocument = {
  ...bound,
  functions: { outer: { name: "outer", parameters: [] }, inner: { name: "inner", parameters: [] } },
  steps: {
    call: at("call", first, { function: "outer" }),
    deeper: at("call", ["outer", "body", "A"], { function: "inner" }),
    again: at("call", ["inner", "body", "B"], { function: "inner" }),
    drive: at("move", ["inner", "body", "A"], { to: { place: "dock" } }),
  },
};

/** What a step does through all that it calls: its kind, its robot and where to. */
function doneBy(document: ProgramDocument, id: string, above: readonly string[] = []): unknown[] {
  const step = document.steps[id];
  const called = String(step?.params.function);
  if (step?.kind !== "call") return [[step?.kind, document.roles[roleOfStep(step) ?? ""]?.device, step?.params.to]];
  const inside = Object.entries(document.steps).filter(([, each]) => each.place?.[0] === called);
  inside.sort(([, one], [, other]) => ((one.place?.[2] ?? "") < (other.place?.[2] ?? "") ? -1 : 1));
  return above.includes(called) ? [] : inside.flatMap(([each]) => doneBy(document, each, [...above, called]));
}

test.each<[what: string, own: Partial<ProgramDocument>, after: number]>([
  ["has it alike", {}, 2],
  [
    "has changed what it calls",
    { steps: { ...nested.steps, drive: at("move", ["inner", "body", "A"], { to: { place: "lab" } }) } },
    4,
  ],
  ["has emptied it", { steps: {} }, 4],
  ["has given it another robot", { roles: { robot: { name: "Robot", device: "robot02" } } }, 4],
  ["has another one of its id", { functions: { ...nested.functions, outer: { name: "other", parameters: [] } } }, 3],
])("a pasted call does what it did where a copy of its program %s, and is brought once", (_, own, after) => {
  const target = { ...nested, ...own };
  const { document } = pasted(nested, ["call"], target);
  const [copy = ""] = Object.keys(document.steps).filter(
    (id) => document.steps[id]?.place?.[0] === "program" && !target.steps[id],
  );
  expect(doneBy(document, copy)).toEqual(doneBy(nested, "call"));
  expect(doneBy(document, "call")).toEqual(doneBy(target, "call"));
  expect(Object.keys(document.functions)).toHaveLength(after);
  expect(pasted(nested, ["call"], document).document.functions).toEqual(document.functions);
  expect(pasted(nested, ["call"], target, "a").document.functions).toEqual(target.functions);
});

test("in their own program pasted steps mean the zone as it is now", () => {
  const changed = { ...cleaning, zones: { z1: { ...hall, name: "Store" } } };
  const { document, params } = pasted(cleaning, ["cover"], changed, "a");
  expect([document.zones, params[0]?.zone]).toEqual([changed.zones, "z1"]);
});

test("what was copied before clippings had zones is read as well", () => {
  const old = { ...clip(cleaning, ["cover"]), zones: undefined };
  expect(clippingFromText(JSON.stringify({ type: "vipo steps 2", ...old }))?.zones).toEqual({});
});
