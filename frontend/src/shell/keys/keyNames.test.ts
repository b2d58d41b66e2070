import { expect, test } from "vitest";
import { ariaKeys, isCharacterKey, nameOfKeys, wordsOfKeys } from "./keyNames";

const NOTHING_HELD = { ctrlKey: false, metaKey: false, shiftKey: false, altKey: false };

test("keys are named by what is held and what is pressed; Cmd counts as Ctrl", () => {
  expect(nameOfKeys({ ...NOTHING_HELD, key: "g", ctrlKey: true, shiftKey: true })).toBe("Ctrl+Shift+G");
  expect(nameOfKeys({ ...NOTHING_HELD, key: "ArrowUp", metaKey: true })).toBe("Ctrl+ArrowUp");
  expect(nameOfKeys({ ...NOTHING_HELD, key: "a" })).toBe("A");
  expect(nameOfKeys({ ...NOTHING_HELD, key: " " })).toBe("Space");
  expect(nameOfKeys({ ...NOTHING_HELD, key: "F8", shiftKey: true })).toBe("Shift+F8");
});

test("what was held to write a character is no part of its name", () => {
  expect(nameOfKeys({ ...NOTHING_HELD, key: "?", shiftKey: true })).toBe("?");
  expect(nameOfKeys({ ...NOTHING_HELD, key: "0", shiftKey: true })).toBe("0");
  const third = { ctrlKey: true, altKey: true, getModifierState: (key: string) => key === "AltGraph" };
  expect(nameOfKeys({ ...NOTHING_HELD, ...third, key: "@" })).toBe("@");
});

test("keys that write are told from others", () => {
  expect(["A", "/", "Shift+B", "F8", "Ctrl+A", "Escape"].map(isCharacterKey)).toEqual([
    true,
    true,
    true,
    false,
    false,
    false,
  ]);
});

test("keys are written as the keyboard has them", () => {
  const german = (key: string) => ({ Ctrl: "Strg", Shift: "Umschalt" })[key] ?? key;
  expect(wordsOfKeys("Ctrl+Shift+ArrowUp", german)).toBe("Strg+Umschalt+↑");
  expect(wordsOfKeys("+", german)).toBe("+");
  expect(wordsOfKeys("Ctrl++", german)).toBe("Strg++");
  expect(ariaKeys(["Ctrl+Z", "U"])).toBe("Control+Z U");
  expect(ariaKeys([])).toBeUndefined();
});
