import { expect, test } from "vitest";
import { applyEdits, type Edit } from "../edits/edits";
import type { OpenProgram } from "../state/context";
import { soundZones } from "@/program/canvas/Zones";
import { EMPTY_DOCUMENT, type ProgramDocument, type Zone } from "@/program/document/document";
import { areaOf, closes, freshNumber, squareAround, withNextCorner } from "./shape";
import { changeZone } from "./zoneTool";

const zone = (name: string, points: Zone["points"]): Zone => ({ name, rule: "slow", points });

test("the area is that of the corners, whichever way round they go", () => {
  const square = squareAround([3, -4]);
  expect(areaOf(square)).toBe(4);
  expect(areaOf([...square].reverse())).toBe(4);
});

test("a press near the first corner closes a zone of three or more", () => {
  const two = [
    [0, 0],
    [2, 0],
  ] as const;
  const three = withNextCorner(two, [2, 2]);
  expect(closes(two, [0, 0.1], 0.3)).toBe(false);
  expect(closes(three, [0, 0.1], 0.3)).toBe(true);
  expect(closes(three, [0, 0.4], 0.3)).toBe(false);
});

test("a double press adds one corner", () => {
  expect(withNextCorner([[1, 1]], [1.01, 1])).toHaveLength(1);
  expect(withNextCorner([[1, 1]], [2, 1])).toHaveLength(2);
});

test("only zones with corners are drawn, and a fresh one has a number of its own", () => {
  const document = {
    ...EMPTY_DOCUMENT,
    zones: { a: zone("Zone 4", squareAround([0, 0])), b: zone("Dock", [[0, 0]]), c: null },
  } as unknown as ProgramDocument;
  expect(soundZones(document).map(([id]) => id)).toEqual(["a"]);
  expect(freshNumber(EMPTY_DOCUMENT)).toBe(1);
  expect(freshNumber({ ...EMPTY_DOCUMENT, zones: { a: zone("Zone 4", squareAround([0, 0])) } })).toBe(5);
});

test("what others change of a zone while it is dragged stays, and a zone that they remove stays away", () => {
  const points = squareAround([3, -4]);
  const before: ProgramDocument = { ...EMPTY_DOCUMENT, zones: { a: zone("Aisle", points), b: zone("Bay", points) } };
  let now: ProgramDocument = { ...EMPTY_DOCUMENT, zones: { a: { ...zone("Gangway", points), rule: "keep_out" } } };
  const open = {
    document: before,
    shared: { getDocument: () => now },
    apply: (edits: readonly Edit[]) => (now = applyEdits(now, edits)),
  } as unknown as OpenProgram;
  const moved = squareAround([5, -4]);
  for (const id of ["a", "b"]) changeZone(open, id, { points: moved });
  expect(now.zones).toEqual({ a: { name: "Gangway", rule: "keep_out", points: moved } });
});
