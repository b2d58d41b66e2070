import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument } from "./document/document";
import { readingsOfRoles, reportedBy, robotsFor } from "./robotReadings";

const device = (id: string, kind: string, reports: string[], can: string[] = [], lifecycle = "approved") => ({
  id,
  kind,
  lifecycle,
  properties: reports.map((name) => ({ name, from: id })),
  methods: can.map((name) => ({ name })),
});
const devices = [
  device("r1", "robot", ["battery"], ["move", "pick"]),
  device("r2", "robot", ["battery", "load"], ["move"]),
  device("r3", "robot", ["pressure"], ["move"], "pending"),
  device("oven", "machine", ["temperature"]),
];
const ids = (found: readonly { id: string }[]) => found.map(({ id }) => id);

test("a role may be any approved robot that can do what it must, or just the one that it is bound to", () => {
  expect(ids(robotsFor(undefined, devices))).toEqual(["r1", "r2"]);
  expect(ids(robotsFor({ can: ["pick"] }, devices))).toEqual(["r1"]);
  expect(ids(robotsFor({ device: "r3" }, devices))).toEqual(["r3"]);
  expect(ids(robotsFor({ device: "oven" }, devices))).toEqual([]);
});

test("what several robots report stands there once", () => {
  expect(reportedBy(devices.slice(0, 2))).toEqual([
    { name: "battery", from: "r1" },
    { name: "load", from: "r2" },
  ]);
});

test("only roles that steps drive have robots, and only those with readings are offered", () => {
  const document: ProgramDocument = {
    ...EMPTY_DOCUMENT,
    roles: { arm: { can: ["pick"] }, idle: { can: [] }, nobody: { can: ["fly"] } },
    steps: {
      a: { kind: "pick", params: { role: "arm" } },
      b: { kind: "operate", params: { device: { role: "nobody" } } },
      c: { kind: "move", params: {} },
    },
  };
  const found = readingsOfRoles(document, devices).map(({ role, readings }) => [role, readings.map((r) => r.name)]);
  expect(found).toEqual([
    ["robot", ["battery", "load"]],
    ["arm", ["battery"]],
  ]);
  expect(readingsOfRoles({ ...document, steps: {} }, devices)).toEqual([]);
});
