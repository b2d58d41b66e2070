import { expect, test } from "vitest";
import type { Device } from "@/api/types";
import { isOnline } from "./online";

function device(id: string, more: Partial<Device> = {}): Device {
  return { id, name: id, lifecycle: "approved", status: "idle", ...more } as unknown as Device;
}
const oven = device("oven01");
const pending = device("mixer03", { lifecycle: "pending", status: "pending" });

test("a pending device that has long said nothing is not online", () => {
  const at = Date.parse("2026-11-22T08:00:00Z");
  const seen = { ...pending, last_seen_at: "2026-11-22T07:59:30Z" };
  expect(isOnline(seen, at)).toBe(true);
  expect(isOnline(seen, at + 20_000)).toBe(false);
  expect(isOnline({ ...pending, last_seen_at: null }, at)).toBe(false);
  expect(isOnline(oven, at)).toBe(true);
  expect(isOnline(device("gone", { status: "offline" }), at)).toBe(false);
});
