import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "./document/document";
import { STEP_KINDS } from "./kinds";
import { choices, givenToRole, methodOf, operable, operated, roleOfStep } from "./operation";
import { surroundingsOf, type SiteDevice } from "./surroundings";
import { chipText, plainText } from "./words/stepWords";

const HONK = { name: "honk", title: "Honk", parameters: [{ name: "times", type: "number" }] };

function device(id: string, kind: string, methods: readonly unknown[]): SiteDevice {
  return { id, name: id, kind, methods, properties: [], lifecycle: "approved" } as unknown as SiteDevice;
}

const NAMED = (name: string) => ({ name, parameters: [] });
const FIRST = device("r1", "robot", [NAMED("move"), NAMED("pick"), NAMED("drop"), HONK]);
const SECOND = device("r2", "robot", [NAMED("move"), HONK, NAMED("openGripper")]);
const PENDING = { ...device("r3", "robot", [NAMED("sing")]), lifecycle: "pending" };
const SHELF = device("shelf", "machine", [NAMED("dispense"), NAMED("turn")]);
const SITE = surroundingsOf([FIRST, SECOND, PENDING, SHELF], []);
const DOCUMENT: ProgramDocument = { ...EMPTY_DOCUMENT, roles: { c: { name: "carrier", device: "r2" } } };

function operate(params: Step["params"]): Step {
  return { kind: "operate", place: null, pos: [0, 0], params } as unknown as Step;
}

test("a robot is operated by its own methods, a machine by those that hand nothing over", () => {
  expect([FIRST, SHELF].map((each) => operable(each).map(({ name }) => name))).toEqual([["honk"], ["turn"]]);
});

test("what is a step of its own is no method to choose, and a robot's own may be called as the fleet's are", () => {
  const all = STEP_KINDS.flatMap(({ method }) => method ?? []).map(NAMED);
  const names = operable(device("r4", "robot", all)).map(({ name }) => name);
  expect(names).toEqual(expect.arrayContaining(["cover", "release"]));
  expect(all.map(({ name }) => name).filter((name) => !names.includes(name))).toEqual(["move", "pick", "drop"]);
});

test("each step that the records give to a role says which", () => {
  const roles = STEP_KINDS.filter(({ drives }) => drives).map(({ kind }) => {
    return roleOfStep({ ...operate({ role: "c" }), kind });
  });
  expect(roles).toEqual(roles.map(() => "c"));
  expect(roles.length).toBeGreaterThan(5);
});

test("any robot of the site may take a role that is bound to none, and each method stands there once", () => {
  const robots = operated({ role: "robot" }, DOCUMENT, SITE);
  expect(robots.map(({ id }) => id)).toEqual(["r1", "r2"]);
  expect(choices(robots).map(({ name }) => name)).toEqual(["honk", "openGripper"]);
  expect(operated({ role: "c" }, DOCUMENT, SITE)).toEqual([SECOND]);
  expect(operated({ device: "shelf" }, DOCUMENT, SITE)).toEqual([SHELF]);
  expect([undefined, null, 3, {}].map((each) => operated(each, DOCUMENT, SITE).length)).toEqual([0, 0, 0, 0]);
});

test("a step says which role carries it out, and can be given to another", () => {
  const step = operate({ device: { role: "c" }, method: "honk" });
  expect([roleOfStep(step), roleOfStep(operate({ device: { device: "shelf" } }))]).toEqual(["c", null]);
  expect(roleOfStep({ ...step, kind: "move", params: {} })).toBe("robot");
  expect(givenToRole(step, "d")).toEqual({ name: "device", value: { role: "d" } });
  expect(givenToRole({ ...step, kind: "move" }, "d")).toEqual({ name: "role", value: "d" });
});

test("a chip says which robot does what, for a robot does not stand where the step does", () => {
  const speaker = { document: DOCUMENT, surroundings: SITE, t: (key: string) => key };
  const say = (params: Step["params"]) => plainText(chipText(operate(params), speaker));
  expect(say({ device: { role: "robot" }, method: "honk", args: { times: 5 } })).toBe("role.default · Honk · 5");
  expect(say({ device: { role: "c" }, method: "honk", args: {} })).toBe("carrier · Honk ?");
  expect(say({ device: { device: "r1" }, method: "honk", args: { times: 1 } })).toBe("r1 · Honk · 1");
  expect(say({ device: { role: "c" } })).toBe("carrier · ?");
  expect(methodOf(operate({ device: { role: "c" }, method: "honk" }), SITE, DOCUMENT).method).toBe(HONK);
});
