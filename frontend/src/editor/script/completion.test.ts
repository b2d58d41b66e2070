import { expect, test } from "vitest";
import { optionsAt, type NamedDevice } from "./completion";

const OVEN: NamedDevice = {
  id: "curingOven01",
  name: "Curing Oven",
  kind: "machine",
  methods: [{ name: "curePaint", parameters: [{ name: "time" }] }],
  properties: [{ name: "temperature", unit: "DEG_C" }],
};
const MIXER: NamedDevice = { ...OVEN, id: "paintMixer01", name: "Paint Mixer A", methods: [] };

const SCRIPT = `class Task(object):
    def new_task(self):
        self.count = 1

    def mix_paint(self, minutes):
        pass

    def branch_1a(self):
        pass

    def run(self, ctx):
        self.robot = ctx.any("pick", "drop")
        self.curing_oven = ctx.get("curingOven01")
        self.new_task()
`;

function labels(line: string): string[] {
  return (optionsAt(`${SCRIPT}\n${line}`, SCRIPT, [OVEN, MIXER])?.options ?? []).map((option) => option.label);
}

test("behind self stand what run gives, functions, variables and the site's other devices", () => {
  const found = labels("        self.");
  expect(found.slice(0, 4)).toEqual(["robot", "curing_oven", "mix_paint", "count"]);
  expect(found).toEqual([...new Set(found)]);
  expect(found).toEqual(expect.arrayContaining(["wait", "end", "notify", "ask", "parallel", "limit"]));
  expect(found).not.toContain("pick");
  expect(found.at(-1)).toBe("paint_mixer_a");
  const mixer = optionsAt("        self.pa", SCRIPT, [OVEN, MIXER])?.options.at(-1);
  expect(mixer).toEqual({ label: "paint_mixer_a", detail: "Paint Mixer A", kind: "device", give: "paintMixer01" });
});

test("behind a device stand what it does and reports, behind a robot its verbs", () => {
  expect(labels("        self.curing_oven.")).toEqual(["cure_paint", "temperature", "location"]);
  expect(labels("        self.robot.p")).toEqual(expect.arrayContaining(["move", "pick", "drop", "cover", "release"]));
  expect(labels("        self.robot.p")).not.toContain("wait");
});

test("devices are offered by id where run gives them", () => {
  expect(labels('        self.x = ctx.get("')).toEqual(["curingOven01", "paintMixer01"]);
  expect(labels("        self.x = ctx.")).toContain("any");
});

test("the word that is completed begins behind the point", () => {
  expect(optionsAt("        self.rob", SCRIPT, [])?.start).toBe(13);
  expect(optionsAt("        1 + ", SCRIPT, [])).toBeNull();
});

test("behind any robot stands what robots report, each reading once", () => {
  const robot = (id: string, ...names: string[]): NamedDevice => ({
    id,
    name: id,
    kind: "robot",
    methods: [],
    properties: names.map((name) => ({ name, unit: null })),
  });
  const given = '        self.robot = ctx.any("pick")';
  const robots = [robot("r1", "battery"), robot("r2", "battery", "wheelSlip")];
  const labels = (using: readonly NamedDevice[]) =>
    optionsAt(`${given}\n        self.robot.`, given, using)?.options.map(({ label, kind }) => `${kind} ${label}`);
  const found = labels(robots) ?? [];
  expect(found).toEqual(expect.arrayContaining(["verb move", "verb pick", "verb drop"]));
  expect(found.filter((each) => !each.startsWith("verb "))).toEqual(["property battery", "property wheel_slip"]);
});

test("behind a robot stand its own methods too, behind any robot those of all, each once", () => {
  const robot = (id: string, ...names: string[]): NamedDevice => ({
    ...OVEN,
    id,
    kind: "robot",
    properties: [],
    methods: names.map((name) => ({ name, parameters: [{ name: "times" }] })),
  });
  const robots = [robot("r1", "move", "honk"), robot("r2", "move", "honk", "openGripper")];
  const given = SCRIPT.replace("self.new_task()", 'self.first = ctx.get("r1")\n        self.new_task()');
  const behind = (line: string) => optionsAt(`${given}\n${line}`, given, [OVEN, ...robots])?.options;
  const verbs = behind("        self.robot.")?.map(({ label }) => label) ?? [];
  expect(verbs.slice(-2)).toEqual(["honk", "open_gripper"]);
  expect(verbs.filter((verb) => verb === "move")).toHaveLength(1);
  expect(behind("        self.first.")?.at(-1)).toEqual({ label: "honk", detail: "(times)", kind: "method" });
});

test("names of every language are completed", () => {
  const oven = { ...OVEN, id: "ofen1", name: "Ofen Süd", methods: [{ name: "öffnen", parameters: [] }] };
  const robot = '        self.träger = ctx.any("pick")';
  const behind = (line: string, script = robot) => {
    const here = optionsAt(`${script}\n${line}`, script, [oven]);
    return [here?.start, here?.options.map(({ label }) => label)] as const;
  };
  expect(behind("        self.ofen_sü")[1]).toEqual(expect.arrayContaining(["träger", "ofen_süd"]));
  expect(behind("        self.ofen_sü")[0]).toBe(robot.length + "\n        self.".length);
  expect(behind("        self.träger.")[1]).toContain("move");
  const given = '        self.ofen_süd = ctx.get("ofen1")';
  expect(behind("        self.ofen_süd.ö", given)[1]).toEqual(["öffnen", "temperature", "location"]);
});
