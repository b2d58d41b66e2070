// @vitest-environment jsdom
import { expect, test } from "vitest";
import { recentsOf, rememberRecent } from "./recents";

test("the last ones are kept for each person, newest first, each once", () => {
  for (const id of ["a", "b", "c", "a"]) rememberRecent("7", id);
  expect(recentsOf("7")).toEqual(["a", "c", "b"]);
  expect(recentsOf("8")).toEqual([]);
  for (let count = 0; count < 20; count += 1) rememberRecent("8", `n${count}`);
  expect(recentsOf("8")).toEqual(["n19", "n18", "n17", "n16", "n15", "n14", "n13", "n12"]);
});

test("what is kept and makes no sense is nothing", () => {
  localStorage.setItem("vipo.recents.9", "{");
  expect(recentsOf("9")).toEqual([]);
});
