import { expect, test } from "vitest";
import { nameFrom, sortFiles } from "./files";

const file = (name: string) => new File([], name);
const NONE = { yaml: null, image: null };

test("header and image are told apart by their names", () => {
  const { yaml, image } = sortFiles(NONE, [file("hall.PGM"), file("hall.yml")]);
  expect([yaml?.name, image?.name]).toEqual(["hall.yml", "hall.PGM"]);
});

test("files chosen later join those that are there", () => {
  const first = sortFiles(NONE, [file("a.yaml")]);
  const both = sortFiles(first, [file("b.png")]);
  expect([both.yaml?.name, both.image?.name]).toEqual(["a.yaml", "b.png"]);
});

test("files of other kinds are left out", () => {
  expect(sortFiles(NONE, [file("notes.txt"), file("yaml"), file("map.yaml.zip")])).toEqual(NONE);
});

test("a name comes out of the header's file name", () => {
  expect(nameFrom("packing_hall.yaml")).toBe("Packing hall");
  expect(nameFrom("second-floor.v2.yml")).toBe("Second floor v2");
});
