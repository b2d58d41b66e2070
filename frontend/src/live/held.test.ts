import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { Device, DeviceProperty } from "@/api/types";
import { asHeld } from "./held";
import { forgetReadings, recordDevice } from "./readings";
import { liveRobots } from "./robots";
import { EMPTY, useLiveStore } from "./store";

const STOP = { active: true, by: "Bo", at: "2026-01-02T03:04:05+00:00" };

function device(id: string, kind: "robot" | "machine", code: string): Device {
  const properties = [] as DeviceProperty[];
  const location = { x: 0, y: 0, z: 0, theta: 0 };
  const told = {
    id,
    kind,
    status: "busy",
    doing: code,
    activity: { code, args: {} },
    properties,
    location,
    carrying: {},
  };
  return told as unknown as Device;
}

const machine = (id: string, value: unknown) => ({
  ...device(id, "machine", "working_percent"),
  properties: [{ name: "jobStatus", value }] as DeviceProperty[],
});
const at = (id: string, x: number) => recordDevice({ id, location: { x, y: 0, z: 0, theta: 0 } }, performance.now());
const progress = (id: string, value: number) =>
  recordDevice({ id, properties: [{ name: "jobStatus", value } as DeviceProperty] }, performance.now());
const deviceById = (...devices: Device[]) => Object.fromEntries(devices.map((each) => [each.id, each]));

beforeEach(() => {
  vi.useFakeTimers();
  forgetReadings();
  useLiveStore.setState({ ...EMPTY, site: "hall" });
});
afterEach(() => {
  useLiveStore.setState(EMPTY);
  vi.useRealTimers();
});

test("while all is stopped robots that stand are held, and one that still moves once it stands", () => {
  at("stands", 0);
  at("moves", 0);
  useLiveStore.setState({
    deviceById: deviceById(device("stands", "robot", "driving"), device("moves", "robot", "driving")),
  });
  expect(useLiveStore.getState().held).toEqual([]);
  at("moves", 0.1);
  useLiveStore.setState({ stop: STOP });
  expect(useLiveStore.getState().held).toEqual(["stands"]);
  vi.advanceTimersByTime(1000);
  at("moves", 0.2);
  vi.advanceTimersByTime(1500);
  expect(useLiveStore.getState().held).toEqual(["stands"]);
  vi.advanceTimersByTime(1000);
  expect(useLiveStore.getState().held).toEqual(["stands", "moves"]);
  useLiveStore.setState({ stop: { ...STOP, active: false } });
  expect(useLiveStore.getState().held).toEqual([]);
});

test("a machine is held when its progress stands; of one that tells none nobody knows", () => {
  progress("oven", 40);
  progress("oven", 41);
  const told = deviceById(machine("oven", 41), device("mixer", "machine", "working"));
  useLiveStore.setState({ deviceById: told, stop: STOP });
  vi.advanceTimersByTime(9000);
  expect(useLiveStore.getState().held).toEqual([]);
  progress("oven", 41);
  vi.advanceTimersByTime(2000);
  expect(useLiveStore.getState().held).toEqual(["oven"]);
});

test("a page that has just opened takes no machine for held that it has not seen move, nor one of an earlier job", () => {
  const look = (id: string, value: unknown) => {
    const told = machine(id, value);
    recordDevice({ id, properties: told.properties }, performance.now());
    useLiveStore.setState({ deviceById: deviceById(told), stop: STOP });
    return useLiveStore.getState().held;
  };
  expect(look("oven", 40)).toEqual([]);
  vi.advanceTimersByTime(60_000);
  expect(look("oven", 40)).toEqual([]);
  vi.advanceTimersByTime(60_000);
  expect(look("oven", 40)).toEqual(["oven"]);
  expect(look("oven", null)).toEqual([]);
});

test("a machine that takes long for each percent is held after twice as long", () => {
  progress("oven", 40);
  vi.advanceTimersByTime(36_000);
  progress("oven", 41);
  useLiveStore.setState({ deviceById: deviceById(machine("oven", 41)), stop: STOP });
  vi.advanceTimersByTime(70_000);
  expect(useLiveStore.getState().held).toEqual([]);
  vi.advanceTimersByTime(3000);
  expect(useLiveStore.getState().held).toEqual(["oven"]);
});

test("a pause before its last progress does not keep a machine from being held", () => {
  progress("oven", 100);
  vi.advanceTimersByTime(3_600_000);
  progress("oven", 0);
  useLiveStore.setState({ deviceById: deviceById(machine("oven", 0)), stop: STOP });
  vi.advanceTimersByTime(119_000);
  expect(useLiveStore.getState().held).toEqual([]);
  vi.advanceTimersByTime(2000);
  expect(useLiveStore.getState().held).toEqual(["oven"]);
});

test("what is held waits; a load or trouble is told as before", () => {
  const held = ["robot", "carrier", "idle"];
  const told = (each: Device) => {
    const { status, activity } = asHeld(each, held);
    return [status, activity?.code];
  };
  expect(told(device("robot", "robot", "driving"))).toEqual(["waiting", "held"]);
  expect(told(device("carrier", "robot", "carrying"))).toEqual(["waiting", "carrying"]);
  expect(told(device("other", "robot", "driving"))).toEqual(["busy", "driving"]);
  expect(told({ ...device("idle", "robot", "ready"), status: "idle" })).toEqual(["idle", "ready"]);
});

test("the map tells who is held", () => {
  at("robot", 0);
  useLiveStore.setState({ deviceById: deviceById(device("robot", "robot", "driving")), stop: STOP });
  expect(liveRobots(performance.now()).map(({ status }) => status)).toEqual(["waiting"]);
});
