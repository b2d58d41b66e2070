/** Templates fit the devices that a site has; that the server draws their scripts without a finding, its own test shows. */
import { expect, test } from "vitest";
import pythonNames from "../../../../tests/cases/names.json";
import scripts from "../../../../tests/cases/templates.json";
import { exampleSite } from "./exampleSite";
import { type Chosen, filled, lacking, TEMPLATES } from "./templates";

const byId = (id: string) => {
  const found = TEMPLATES.find((each) => each.id === id);
  if (!found) throw new Error(id);
  return found;
};
const names = (id: string, chosen: Chosen = {}, site = exampleSite()) =>
  byId(id)
    .slots(site, chosen)
    .map((slot) => [slot.name, filled(byId(id).slots(site, chosen), slot.name, chosen)?.name]);

test("each template writes the script that the server is tested with", () => {
  const written = TEMPLATES.map(({ id, bind }) => [id, bind(exampleSite(), {}).script.split("\n")]);
  expect(Object.fromEntries(written)).toEqual(scripts);
});

test("a template takes the machines that can do it, where things come in and go out first", () => {
  expect(names("fetch")).toEqual([
    ["source", "Item Inventory"],
    ["target", "Drop-off"],
  ]);
  expect(names("process")).toEqual([
    ["source", "Item Inventory"],
    ["machine", "Painting Machine"],
    ["target", "Drop-off"],
  ]);
  expect(names("wait")[0]).toEqual(["watched", "Item Inventory"]);
});

test("what was chosen for one slot decides what fits the next", () => {
  const chosen = { source: "paintInventory01", target: "curingOven01" };
  expect(names("fetch", chosen)).toEqual([
    ["source", "Paint Inventory"],
    ["target", "Paint Mixer A"],
  ]);
  const slots = byId("fetch").slots(exampleSite({ paintMixer03: null }), chosen);
  expect(slots[1]?.candidates.map(({ name }) => name)).toEqual(["Paint Mixer A", "Paint Mixer B", "Painting Machine"]);
});

test("a patrol goes to no place twice", () => {
  const stops = names("patrol", { stop2: "goodsIn" }).map(([, name]) => name);
  expect(new Set(stops).size).toBe(3);
});

test("a template says what the site lacks for it", () => {
  const lacks = (id: string, site = exampleSite()) => lacking(byId(id).slots(site, {}))?.name ?? null;
  expect(TEMPLATES.map(({ id }) => lacks(id))).toEqual([null, null, null, null, null]);
  const withoutRobots = exampleSite({ robot01: null, robot02: null, robot03: null });
  expect([lacks("patrol", withoutRobots), lacks("charge", withoutRobots)]).toEqual(["stop1", "dock"]);
  const nothing = { devices: [], places: [] };
  expect(TEMPLATES.map(({ id }) => lacks(id, nothing))).toEqual(["source", "source", "stop1", "watched", "source"]);
});

test("a machine that is not approved yet is not offered", () => {
  const site = exampleSite({ itemInventory01: { lifecycle: "pending" } });
  expect(names("fetch", {}, site)[0]).toEqual(["source", "Paint Inventory"]);
});

test("two machines of one name are told apart by their ids", () => {
  const site = exampleSite({ paintMixer02: { name: "Paint Mixer A" } });
  const { script } = byId("fetch").bind(site, { source: "paintInventory01", target: "paintMixer02" });
  expect(script).toContain('self.paint_mixer_a_paint_mixer02 = ctx.get("paintMixer02")');
});

test("a method is filled in with what it takes for sure", () => {
  const { script, does } = byId("process").bind(exampleSite(), {});
  expect(script).toContain('self.painting_machine.operate("paint", {"time": 1})');
  expect(does.map(({ key, stop }) => [key, stop])).toEqual([
    ["pick", 0],
    ["drop", 1],
    ["operate", 1],
    ["pick", 1],
    ["drop", 2],
  ]);
});

test("devices keep their names in every language, beside what a task has itself", () => {
  const site = exampleSite({ itemInventory01: { name: "Lager Süd" }, paintMachine01: { name: "名前" } });
  const { script } = byId("process").bind(site, {});
  expect(script).toContain('self.lager_süd = ctx.get("itemInventory01")');
  expect(script).toContain("self.名前.operate(");
  for (const name of pythonNames.reserved) {
    const own = exampleSite({ itemInventory01: { name } });
    expect(byId("fetch").bind(own, {}).script).not.toContain(`self.${name} = ctx.get("itemInventory01")`);
  }
});
