import { expect, test } from "vitest";
import type { Alert } from "@/api/types";
import { applyAlert } from "@/live/alerts";
import { byDevice, concerns, devicesIn, freshErrors, inState, knownOf, sortAlerts, worstOf } from "./alerts";

function alert(id: number, more: Partial<Alert> = {}): Alert {
  const at = `2026-11-21T12:00:0${id}+00:00`;
  return {
    ...{ id, device: "mixer", code: "error", severity: "error", role: "viewer", args: {}, text: "", count: 1 },
    ...{ state: "open", first_at: at, last_at: at, over_at: null, seen_by: "", seen_at: null },
    ...more,
  };
}

const ids = (alerts: readonly Alert[]) => alerts.map((each) => each.id);

test("the worst come first, of the same severity the latest", () => {
  const all = [alert(1), alert(2, { severity: "info" }), alert(3), alert(4, { severity: "warning" })];
  expect(ids(sortAlerts(all))).toEqual([3, 1, 4, 2]);
  expect(worstOf(all)).toBe("error");
  expect(worstOf([])).toBeNull();
});

test("alerts are chosen by state, device and role", () => {
  const all = [alert(1), alert(2, { state: "seen", device: "oven" }), alert(3, { role: "admin" })];
  expect(ids(inState(all, "open"))).toEqual([1, 3]);
  expect([...byDevice(all)].map(([device, found]) => [device, ids(found)])).toEqual([
    ["mixer", [3, 1]],
    ["oven", [2]],
  ]);
  expect(all.map((each) => concerns(each, "author"))).toEqual([true, true, false]);
  expect(all.every((each) => concerns(each, "admin"))).toBe(true);
});

test("a live message adds, replaces and takes out", () => {
  const known = [alert(1), alert(2)];
  expect(ids(applyAlert(known, alert(3)))).toEqual([3, 1, 2]);
  expect(applyAlert(known, alert(2, { state: "seen" })).find((each) => each.id === 2)?.state).toBe("seen");
  expect(ids(applyAlert(known, alert(1, { state: "over" })))).toEqual([2]);
});

test("only errors that are new, or happened again, are announced, and none at first sight", () => {
  const before = [alert(1), alert(2, { severity: "warning" })];
  const now = [
    alert(1, { count: 2 }),
    alert(2, { severity: "warning", count: 2 }),
    alert(3),
    alert(4, { state: "seen" }),
  ];
  expect(ids(freshErrors(knownOf(before), now))).toEqual([1, 3]);
  expect(freshErrors(knownOf(now), now)).toEqual([]);
  expect(freshErrors(null, now)).toEqual([]);
});

test("the devices of a run's steps are found at any depth", () => {
  const steps = { a: { params: { at: { device: "oven" }, value: { op: "<", args: [{ at: { device: "mixer" } }] } } } };
  expect(devicesIn(steps)).toEqual(["oven", "mixer"]);
  expect(devicesIn(null)).toEqual([]);
});
