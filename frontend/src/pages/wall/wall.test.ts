import { deflateSync } from "node:zlib";
import { expect, test } from "vitest";
import { applyMessage, codeOf, countOnline, unpackMap, type Picture, type WallDevice } from "./wall";

const robot: WallDevice = {
  id: "r1",
  name: "TurtleBot 1",
  kind: "robot",
  device_class: "turtlebot",
  icon: "turtle",
  status: "idle",
  done: true,
  activity: null,
  location: { x: 1, y: 2, theta: 0 },
  size: null,
  properties: [],
};
const oven: WallDevice = { ...robot, id: "oven", name: "Oven", kind: "machine", status: "offline" };
const picture: Picture = {
  site: "Hall",
  stop: { active: false, at: null },
  devices: [robot, oven],
  runs: [],
  alerts: [],
  more_alerts: 0,
};

test("a change of a device changes that device alone", () => {
  const change = { id: "r1", status: "busy" as const, location: { x: 3, y: 2, theta: 1 } };
  const after = applyMessage(picture, { type: "devices", devices: [change, { id: "stranger", status: "idle" }] });
  expect(after?.devices).toEqual([{ ...robot, ...change }, oven]);
});

test("a picture takes the place of the one before, and a beat of none", () => {
  const other = { type: "picture" as const, ...picture, site: "Shed", devices: [] };
  expect(applyMessage(picture, other)?.site).toBe("Shed");
  expect(applyMessage(picture, { type: "beat" })).toBe(picture);
  expect(applyMessage(null, { type: "devices", devices: [] })).toBeNull();
});

test("the cells of a map are unpacked as they were", async () => {
  const cells = Uint8Array.from([0, 100, 255, 0, 0, 100]);
  const packed = deflateSync(cells).toString("base64");
  const map = { version: 3, width: 3, height: 2, resolution_m: 0.5, origin: { x: 0, y: 0 }, places: [], cells: packed };
  expect(await unpackMap(map)).toEqual({ ...map, cells });
});

test("who is offline does not count as online", () => {
  expect(countOnline(picture.devices)).toEqual({ online: 1, all: 2 });
});

test("the code is what stands behind the sign #", () => {
  expect([codeOf("#abc"), codeOf("")]).toEqual(["abc", ""]);
});
