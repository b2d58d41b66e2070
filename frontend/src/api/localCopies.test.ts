// @vitest-environment jsdom
import "fake-indexeddb/auto";
import { expect, test } from "vitest";
import { clippingOf, keepOnlyOf, removeAll } from "./localCopies";

const kept = () => Object.keys(localStorage).sort();

test("copied steps are kept for who copied them, and for nobody after signing out", async () => {
  for (const person of ["1", "2"]) localStorage.setItem(clippingOf(person), "steps");
  localStorage.setItem("vipo.theme", "dark");
  await keepOnlyOf("2");
  expect(kept()).toEqual([clippingOf("2"), "vipo.theme"]);
  await removeAll();
  expect(kept()).toEqual(["vipo.theme"]);
});
