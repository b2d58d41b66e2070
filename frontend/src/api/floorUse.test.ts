import { expect, test, vi } from "vitest";
import { utcOffset } from "./floorUse";

test("days begin earlier than those of UTC to the east of it, later to the west", () => {
  const now = new Date("2026-11-23T12:00:00Z");
  const offsets = [-60, 480, 0].map((minutes) => {
    vi.spyOn(now, "getTimezoneOffset").mockReturnValue(minutes);
    return utcOffset(now);
  });
  expect(offsets).toEqual([60, -480, 0]);
});
