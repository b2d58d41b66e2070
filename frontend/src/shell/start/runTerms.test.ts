import { expect, test } from "vitest";
import { termsToSend, USUAL } from "./runTerms";

test("nothing is sent where all is as usual", () => {
  expect(termsToSend(USUAL)).toEqual({});
});

test("times of the browser's zone are sent as moments, and nonsense is not", () => {
  const local = "2026-11-23T14:30";
  const sent = termsToSend({ priority: "high", notBefore: local, deadline: "2026-11-23T16:00" });
  expect(sent).toEqual({
    priority: "high",
    not_before: new Date(2026, 10, 23, 14, 30).toISOString(),
    deadline: new Date(2026, 10, 23, 16, 0).toISOString(),
  });
  expect(termsToSend({ ...USUAL, deadline: "tomorrow" })).toBeNull();
});
