import { expect, test } from "vitest";
import { askedAt, mentionedIn, offered, piecesOf, withName } from "./mentions";

const ANN = { id: 1, name: "Ann" };
const ANN_BERG = { id: 2, name: "Ann Berg" };
const OTHER_ANN = { id: 3, name: "Ann" };
const BERND = { id: 4, name: "Bernd Öhl" };
const ALL = [ANN, ANN_BERG, BERND];

test("the longest name after an @ is meant, and all who have the same one", () => {
  expect(mentionedIn("@Ann Berg, see what @bernd öhl says", ALL)).toEqual([2, 4]);
  expect(mentionedIn("Ask @Ann!", [...ALL, OTHER_ANN])).toEqual([1, 3]);
});

test("an address, a longer word and a name without @ mention nobody", () => {
  expect(mentionedIn("write to x@Ann or Ann", ALL)).toEqual([]);
  expect(mentionedIn("@Anna @Ann_1 @ Ann", ALL)).toEqual([]);
  expect(mentionedIn("@Ann", [])).toEqual([]);
});

test("a text is parted at names and loses no letter", () => {
  const text = "Hm @@Ann Berg? @nobody @Ann";
  const pieces = piecesOf(text, ALL);
  expect(pieces.map((each) => each.text).join("")).toBe(text);
  expect(pieces.flatMap(({ person }) => person?.id ?? [])).toEqual([2, 1]);
});

test("what is typed after an @ asks for a name until two words have been typed", () => {
  expect(askedAt("Hm @an", 6)).toEqual({ from: 3, letters: "an" });
  expect(askedAt("@Ann Be", 7)).toEqual({ from: 0, letters: "Ann Be" });
  expect(["@Ann Be ", "x@an", "@ an", "no", "@an\nb"].map((text) => askedAt(text, text.length))).toEqual([
    null,
    null,
    null,
    null,
    null,
  ]);
  expect(askedAt("@an later", 3)).toEqual({ from: 0, letters: "an" });
});

test("names are offered by the beginning of each of their words, and not once they are whole", () => {
  const names = (letters: string) => offered({ from: 0, letters }, ALL).map(({ id }) => id);
  expect(names("be")).toEqual([2, 4]);
  expect(names("Ö")).toEqual([4]);
  expect(names("ann")).toEqual([2]);
  expect(names("")).toEqual([1, 2, 4]);
});

test("a chosen name takes the place of what was typed, with one space after it", () => {
  expect(withName("Hm @an", { from: 3, letters: "an" }, ANN_BERG)).toEqual({ text: "Hm @Ann Berg ", caret: 13 });
  expect(withName("@an so", { from: 0, letters: "an" }, ANN)).toEqual({ text: "@Ann so", caret: 5 });
});
