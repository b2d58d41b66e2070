import { expect, test } from "vitest";
import page from "../../index.html?raw";
import { entryOf } from "./register";

test("a page is told from another by its script", () => {
  const built = '<script type="module" crossorigin src="/assets/index-B3sRZ1-c.js"></script>';
  expect(entryOf(`<head>${built}</head>`)).toBe("/assets/index-B3sRZ1-c.js");
});

test("a page that is not a built one of ours has none", () => {
  expect(entryOf(page)).toBeNull();
  expect(entryOf("<title>502</title>")).toBeNull();
});
