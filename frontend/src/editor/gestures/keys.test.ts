import { expect, test } from "vitest";
import { nameOfKeys } from "./keys";

test("keys are named as the commands write them", () => {
  const held = { ctrlKey: false, metaKey: false, shiftKey: false, altKey: false };
  expect(nameOfKeys({ ...held, key: "g", ctrlKey: true, shiftKey: true })).toBe("Ctrl+Shift+G");
  expect(nameOfKeys({ ...held, key: "ArrowUp", metaKey: true })).toBe("Ctrl+ArrowUp");
  expect(nameOfKeys({ ...held, key: "a" })).toBe("A");
});
