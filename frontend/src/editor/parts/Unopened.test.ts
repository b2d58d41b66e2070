import { expect, test } from "vitest";
import { unopenedReason } from "./Unopened";

test.each([
  ["connecting", null, "coming"],
  ["live", null, "coming"],
  ["reconnecting", null, "away"],
  ["refused", 4401, "signed_out"],
  ["refused", 4403, "gone"],
  ["refused", 4404, "gone"],
  ["refused", 4429, "many"],
  ["refused", 4400, "refused"],
  ["refused", null, "refused"],
] as const)("a program that is not here while the connection is %s (%s) is %s", (connection, closedWith, reason) => {
  expect(unopenedReason({ connection, closedWith })).toBe(reason);
});
