import { expect, test } from "vitest";
import { keyBetween, keysBetween } from "./order";

test("a key between two neighbours sorts between them", () => {
  const key = keyBetween("A", "B");
  expect(key > "A" && key < "B").toBe(true);
});

test("a thousand keys appended stay in order and short", () => {
  let last = keyBetween(null, null);
  for (let count = 0; count < 1000; count += 1) {
    const next = keyBetween(last, null);
    expect(next > last).toBe(true);
    last = next;
  }
  expect(last.length).toBeLessThan(40);
});

test("one can always go to the front", () => {
  let first = keyBetween(null, null);
  for (let count = 0; count < 200; count += 1) {
    const next = keyBetween(null, first);
    expect(next < first).toBe(true);
    first = next;
  }
});

test("one can always go in between", () => {
  let [low, high] = ["V", "W"];
  for (let count = 0; count < 200; count += 1) {
    const key = keyBetween(low, high);
    expect(key > low && key < high).toBe(true);
    if (count % 2) low = key;
    else high = key;
  }
});

test("keys that are equal by accident give one behind both", () => {
  expect(keyBetween("V", "V") > "V").toBe(true);
});

test("keys in a row ascend between their ends; equal ends leave no room", () => {
  const keys = keysBetween("A", "B", 20) ?? [];
  expect(keys).toHaveLength(20);
  expect([...keys].sort()).toEqual(keys);
  expect(keys.every((key) => key > "A" && key < "B")).toBe(true);
  expect(keysBetween("A", "A", 1)).toBeNull();
  expect(keysBetween("B", "A", 1)).toBeNull();
});

test("there is room behind any key that somebody else wrote", () => {
  for (const key of ["~", "", "z".repeat(40), "ä", "0"])
    expect((keysBetween(key, null, 3) ?? [])[0] ?? "").not.toBe("");
});
