import { expect, test } from "vitest";
import { isUsable, kindOf, nameFrom, NO_FILES, sortFiles } from "./files";

const file = (name: string) => new File([], name);
const NONE = NO_FILES;

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
  expect(sortFiles(NONE, [file("notes.txt"), file("yaml"), file("map.yaml.txt")])).toEqual(NONE);
});

test("a name comes out of the header's file name", () => {
  expect(nameFrom("packing_hall.yaml")).toBe("Packing hall");
  expect(nameFrom("second-floor.v2.yml")).toBe("Second floor v2");
});

test("an archive stands for both files, and two files for an archive", () => {
  const packed = sortFiles({ ...NONE, yaml: file("a.yaml") }, [file("hall.zip")]);
  expect([packed.yaml, packed.image, packed.archive?.name]).toEqual([null, null, "hall.zip"]);
  expect(sortFiles(packed, [file("notes.txt")])).toEqual(packed);
  expect(sortFiles(packed, [file("b.yaml")]).archive).toBeNull();
});

test("an image without a header is a picture of a plan, but for a PGM", () => {
  expect(kindOf(sortFiles(NONE, [file("plan.JPG")]))).toBe("picture");
  expect(kindOf(sortFiles(NONE, [file("hall.pgm")]))).toBe("none");
  expect(kindOf(sortFiles(NONE, [file("hall.png"), file("hall.yaml")]))).toBe("map");
  expect(kindOf(sortFiles(NONE, [file("hall.zip")]))).toBe("map");
  expect(kindOf(NONE)).toBe("none");
});

test("a drawing stands for itself, and a file of a map for it", () => {
  const drawn = sortFiles({ ...NONE, yaml: file("a.yaml") }, [file("Hall.DXF")]);
  expect([drawn.yaml, drawn.drawing?.name, kindOf(drawn)]).toEqual([null, "Hall.DXF", "drawing"]);
  expect(kindOf(sortFiles(drawn, [file("b.yaml")]))).toBe("map");
});

test("what can be no map is told apart: a building file is YAML, too", () => {
  const names = ["a.yaml", "b.PNG", "c.zip", "d.dxf", "e.dwg", "f.lif.json", "g.building.yaml", "pgm"];
  expect(names.filter((name) => isUsable(file(name)))).toEqual(["a.yaml", "b.PNG", "c.zip", "d.dxf"]);
  expect(sortFiles(NONE, [file("g.building.yaml")])).toEqual(NONE);
});
