import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import comments from "@/i18n/en/comments.json";
import type { Thread } from "@/api/types";
import type { Link } from "@/program/scene/links";
import { toMetres } from "@/map/plane/projection";
import type { OpenProgram } from "../state/context";
import { aboutFrom, aboutOf } from "./about";

const OPEN = {
  document: { steps: { a: { kind: "wait" }, b: { kind: "move" } } },
  compiled: { numbers: { a: "1", b: "2" } },
  scene: {
    chips: new Map([["a", { box: { left: 46, top: -92 } }]]),
    links: [
      {
        from: "a",
        to: "b",
        points: [
          { x: 0, y: 0 },
          { x: 92, y: 0 },
        ],
      },
    ],
  },
  t: (key: string, values?: Record<string, string>) => [key, ...Object.values(values ?? {})].join(" "),
} as unknown as OpenProgram;

beforeAll(() => i18next.init({ lng: "en", resources: { en: { translation: { comments } } } }));

const ARROW = { from: "a", to: "b" } as Link;
const NOTHING = { steps: [], link: null, at: null };

test("a comment is about the selected step, with the place of its pin", () => {
  expect(aboutFrom(OPEN, { ...NOTHING, steps: ["a"], at: [3, 4] })).toEqual({
    anchor: { kind: "construct", root: "steps", id: "a", x: 1, y: 2 },
    label: "1 kind.wait",
  });
});

test("a comment of an arrow's menu is about the arrow, midway", () => {
  const [x, y] = toMetres({ x: 46, y: 0 });
  expect(aboutFrom(OPEN, { ...NOTHING, steps: ["b"], link: ARROW, at: [3, 4] })).toEqual({
    anchor: { kind: "arrow", id: "a", to: "b", x, y },
    label: "1 kind.wait → 2 kind.move",
  });
});

test("a comment on a moment of a run says which, and with what its writer called it", () => {
  const nothing = { root: null, id: null, to: null, x: null, y: null };
  const anchor = { ...nothing, kind: "moment", run: "r", number: 12, t_s: 34.2 };
  const about = (label: string) => aboutOf(OPEN, { anchor, label } as Thread);
  expect([about(""), about("2 Paint")]).toEqual(["Run 12 at 0:34", "Run 12 at 0:34 · 2 Paint"]);
});

test("a comment of the floor's menu is about the place", () => {
  expect(aboutFrom(OPEN, { ...NOTHING, at: [3, 4.56] })).toEqual({
    anchor: { kind: "place", x: 3, y: 4.56 },
    label: "Place 3.0, 4.6 m",
  });
});

test("without a step, an arrow and a place it is about the program, also with several steps or one that is gone", () => {
  const program = { anchor: { kind: "program" }, label: "" };
  expect([[], ["a", "b"], ["gone"]].map((steps) => aboutFrom(OPEN, { ...NOTHING, steps }))).toEqual([
    program,
    program,
    program,
  ]);
});
