// @vitest-environment jsdom
import { expect, test } from "vitest";
import { changeKeymap, keysOf, openKeymap, PLAIN_KEYMAP, readKeymap, useKeymap } from "./keymap";

const MOVE = { id: "move", keys: ["M"] };

test("a command has its own keys until a person gives it others", () => {
  expect(keysOf(MOVE, PLAIN_KEYMAP)).toEqual(["M"]);
  expect(keysOf(MOVE, { own: { move: ["Ctrl+M"] }, characters: true })).toEqual(["Ctrl+M"]);
  expect(keysOf({ ...MOVE, fixed: true }, { own: { move: ["Ctrl+M"] }, characters: true })).toEqual(["M"]);
});

test("keys that write a character can be switched off, all others stay", () => {
  const keys = ["M", "Shift+M", "Ctrl+M", "F2"];
  expect(keysOf({ id: "move", keys }, { own: {}, characters: false })).toEqual(["Ctrl+M", "F2"]);
});

test("each person finds the own keys again in this browser", () => {
  openKeymap("7");
  changeKeymap({ own: { move: ["Ctrl+M"] } });
  changeKeymap({ characters: false });
  openKeymap("8");
  expect(useKeymap.getState()).toEqual({ person: "8", own: {}, characters: true });
  openKeymap("7");
  expect(useKeymap.getState()).toEqual({ person: "7", own: { move: ["Ctrl+M"] }, characters: false });
});

test("what is kept and makes no sense is left out", () => {
  expect(readKeymap("{")).toEqual(PLAIN_KEYMAP);
  expect(readKeymap('{"own": {"move": 3, "pick": ["K"]}}')).toEqual({ own: { pick: ["K"] }, characters: true });
});
