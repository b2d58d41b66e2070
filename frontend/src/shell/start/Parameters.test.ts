import { expect, test } from "vitest";
import { completed } from "./Parameters";

const PARAMETERS = [
  { name: "boxes", type: "number", default: 2 },
  { name: "shade", type: "text" },
];

test("a run takes what is given and the defaults for the rest", () => {
  expect(completed(PARAMETERS, { shade: "teal" })).toEqual({ boxes: 2, shade: "teal" });
  expect(completed(PARAMETERS, { boxes: 0, shade: "teal" })).toEqual({ boxes: 0, shade: "teal" });
});

test("a run waits for what has no default", () => {
  expect(completed(PARAMETERS, {})).toBeNull();
});
