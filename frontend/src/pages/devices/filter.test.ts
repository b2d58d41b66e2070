import { expect, test } from "vitest";
import type { Device } from "@/api/types";
import { batteryOf, filterDevices, jobOf, methodNames, pendingOf, NO_FILTER } from "./filter";

function device(id: string, more: Partial<Device> = {}): Device {
  const base = { id, name: id, kind: "machine", lifecycle: "approved", status: "idle", doing: "" };
  return { ...base, properties: [], methods: [], ...more } as unknown as Device;
}
const method = (name: string, title: string) => ({
  name,
  title,
  topic: `dev/${name}`,
  message_type: "",
  parameters: [],
});
const holding = (name: string, value: number | string, unit = "") =>
  [
    { name, title: "", type: "number", unit, minimum: null, maximum: null, options: [], value },
  ] satisfies Device["properties"];

const oven = device("oven01", { name: "Curing Oven", methods: [method("cure", "Cure")] });
const mixer = device("mixer01", { name: "Paint Mixer", status: "busy", methods: [method("mixPaint", "Mix")] });
const robot = device("robot01", {
  name: "TurtleBot",
  kind: "robot",
  methods: [method("move", "Drive"), method("cure", "")],
});
const pending = device("mixer03", { lifecycle: "pending", status: "pending" });
const retired = device("old", { lifecycle: "retired" });
const ALL = [oven, mixer, robot, retired, pending];
const ids = (found: readonly Device[]) => found.map((each) => each.id);

test("those that wait for approval come first, retired ones not at all", () => {
  expect(ids(filterDevices(ALL, NO_FILTER))).toEqual(["mixer03", "oven01", "mixer01", "robot01"]);
});

test("every typed word must be found, in name, id, method or topic", () => {
  expect(ids(filterDevices(ALL, { ...NO_FILTER, query: " paint MIX " }))).toEqual(["mixer01"]);
  expect(ids(filterDevices(ALL, { ...NO_FILTER, query: "dev/move" }))).toEqual(["robot01"]);
  expect(filterDevices(ALL, { ...NO_FILTER, query: "paint oven" })).toEqual([]);
});

test("status, type and method narrow the list together", () => {
  expect(ids(filterDevices(ALL, { ...NO_FILTER, status: "busy" }))).toEqual(["mixer01"]);
  expect(ids(filterDevices(ALL, { ...NO_FILTER, method: "cure" }))).toEqual(["oven01", "robot01"]);
  expect(ids(filterDevices(ALL, { ...NO_FILTER, method: "cure", kind: "robot" }))).toEqual(["robot01"]);
});

test("methods are listed once, by the alphabet", () => {
  expect(methodNames(ALL)).toEqual(["cure", "mixPaint", "move"]);
});

test("a battery is read only where it is a number", () => {
  expect(batteryOf(device("a", { properties: holding("battery", 84) }))).toBe(84);
  expect(batteryOf(device("a", { properties: holding("battery", 84, "PERCENT") }))).toBe(84);
  expect(batteryOf(device("a", { properties: holding("battery", 12.6, "V") }))).toBeNull();
  expect(batteryOf(device("a", { properties: holding("battery", "full") }))).toBeNull();
  expect(batteryOf(oven)).toBeNull();
});

test("a job is a share of one, and only while busy", () => {
  const job = (value: number, status: Device["status"]) =>
    device("a", { status, properties: holding("jobStatus", value) });
  expect(jobOf(job(75, "busy"))).toBe(0.75);
  expect(jobOf(job(180, "busy"))).toBe(1);
  expect(jobOf(job(75, "idle"))).toBeNull();
});

test("an admin is asked about the pending device that is looked at, else about the first", () => {
  const second = device("mixer04", { lifecycle: "pending", status: "pending" });
  const all = [...ALL, second];
  expect(pendingOf(all, "mixer04")).toBe(second);
  expect(pendingOf(all, "mixer01")).toBe(pending);
  expect(pendingOf(all, undefined)).toBe(pending);
  expect(pendingOf([oven], "oven01")).toBeUndefined();
});
