import { expect, test } from "vitest";
import { usualSeconds } from "./usualTime";

const run = (seconds: number, version = 3, status: "finished" | "failed" = "finished") => ({
  status,
  version,
  started_at: "2026-11-28T08:00:00Z",
  ended_at: new Date(Date.parse("2026-11-28T08:00:00Z") + seconds * 1000).toISOString(),
});

test("a run mostly takes the middle of what those of its version took that ended well", () => {
  expect(usualSeconds([run(60), run(300), run(90), run(5, 3, "failed"), run(1000, 2)], 3)).toBe(90);
});

test("of a new version nobody knows, so those before it are asked", () => {
  expect(usualSeconds([run(60), run(300)], 4)).toBe(300);
  expect(usualSeconds([run(5, 3, "failed")], 3)).toBeNull();
  expect(usualSeconds([], 3)).toBeNull();
  expect(usualSeconds([{ ...run(60), started_at: null }], 3)).toBeNull();
});
