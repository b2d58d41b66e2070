// @vitest-environment jsdom
import { renderHook } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Device } from "@/api/types";
import { useQuietDevices } from "./quietDevices";

const METHOD = { name: "paint", title: "", topic: "", message_type: "", parameters: [] };
const OVEN = {
  id: "oven",
  name: "Oven",
  kind: "machine",
  device_class: "oven",
  status: "idle",
  lifecycle: "approved",
  location: { x: 1, y: 2, z: 0, theta: 0 },
  size: { x: 1, y: 1, z: 1 },
  capacity: 1,
  gives: [],
  takes: [],
  asks: [],
  methods: [METHOD],
  properties: [{ name: "heat", unit: "C", type: "number", value: 20, options: [], title: "", minimum: 0, maximum: 9 }],
} as unknown as Device;
const [HEAT] = OVEN.properties as [Device["properties"][number]];

test("devices of an open program change with what they say of themselves, and not with what they measure", () => {
  const { result, rerender } = renderHook(useQuietDevices, { initialProps: [OVEN] });
  const first = result.current;
  rerender([{ ...OVEN, properties: [{ ...HEAT, value: 21 }], last_seen_at: "2026-12-01T06:00:00Z" }]);
  expect(result.current).toBe(first);
  const others: Partial<Device>[] = [
    { properties: [{ ...HEAT, unit: "K" }] },
    { properties: [{ ...HEAT, name: "warmth" }] },
    { methods: [{ ...METHOD, name: "dry" }] },
    { capacity: 2 },
    { kind: "robot" },
    { device_class: "kiln" },
    { size: { x: 2, y: 1, z: 1 } },
  ];
  for (const other of others) {
    rerender([OVEN]);
    const before = result.current;
    rerender([{ ...OVEN, ...other }]);
    expect([other, result.current === before]).toEqual([other, false]);
  }
});

test("a description is written once, however often other devices tell something", () => {
  let count = 0;
  const counted = { ...OVEN };
  Object.defineProperty(counted, "methods", { enumerable: true, get: () => ((count += 1), [METHOD]) });
  const { rerender } = renderHook(useQuietDevices, { initialProps: [counted, OVEN] });
  for (let at = 0; at < 5; at += 1) rerender([counted, { ...OVEN, location: { x: at, y: 0, z: 0, theta: 0 } }]);
  expect(count).toBe(1);
});
