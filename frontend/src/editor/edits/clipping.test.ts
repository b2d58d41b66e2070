import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step, type Value, type Zone } from "@/program/document/document";
import { PROGRAM } from "@/program/document/tree";
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

test("a program whose steps have no robot yet takes the pasted one's as its own, and one that has a robot keeps it", () => {
  const { document, params } = pasted(bound, ["go"], EMPTY_DOCUMENT);
  expect(document.roles).toEqual(bound.roles);
  expect(params).toEqual([{ to: { place: "dock" } }]);
  const own = pasted(bound, ["go"], { ...driving, roles: { robot: { name: "Robot", device: "robot02" } } });
  expect(own.document.roles).toEqual({ robot: { name: "Robot", device: "robot02" } });
  expect(pasted(bound, ["go"], { ...bound, roles: {} }, "a").document.roles).toEqual({});
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
  const known = { ...EMPTY_DOCUMENT, functions: cleaning.functions };
  expect(pasted(cleaning, ["call"], known).document.zones).toEqual({});
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

test("in their own program pasted steps mean the zone as it is now", () => {
  const changed = { ...cleaning, zones: { z1: { ...hall, name: "Store" } } };
  const { document, params } = pasted(cleaning, ["cover"], changed, "a");
  expect([document.zones, params[0]?.zone]).toEqual([changed.zones, "z1"]);
});

test("what was copied before clippings had zones is read as well", () => {
  const old = { ...clip(cleaning, ["cover"]), zones: undefined };
  expect(clippingFromText(JSON.stringify({ type: "vipo steps 2", ...old }))?.zones).toEqual({});
});
