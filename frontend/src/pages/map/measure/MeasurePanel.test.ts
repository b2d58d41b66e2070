import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import measure from "@/i18n/en/screens/measure.json";
import { saidOf } from "./MeasurePanel";
import { NOTHING, stepped, withEnd, type Measuring } from "./measuring";

beforeAll(() => i18next.init({ lng: "en", resources: { en: { translation: { measure } } } }));

const said = (measuring: Measuring) => saidOf(measuring, i18next.t).replaceAll("\u202f", " ");
const byKeys = (measuring: Measuring, x: number, y: number) => stepped(measuring, [x, y], [x, y]);
const put = (measuring: Measuring, x: number, y: number) => withEnd(byKeys(measuring, x, y), [x, y]);

test("each end, the length so far and the whole are read out", () => {
  expect(said(NOTHING)).toBe("");
  expect(said(byKeys(NOTHING, 1, 2))).toMatch(/^Cross-hair at 1/);
  const begun = put(NOTHING, 1, 2);
  expect(said(begun)).toMatch(/^One end is at 1/);
  expect(said(byKeys(begun, 4, 6))).toMatch(/^5\.00 m up to 4/);
  expect(said(put(begun, 4, 6))).toBe("5.00 m measured");
});

test("whoever moves on from a finished line by keys hears where the cross-hair is", () => {
  const measured = put(put(NOTHING, 1, 2), 4, 6);
  expect(said(byKeys(measured, 4.05, 6))).toMatch(/^Cross-hair at 4\.05/);
  expect(said(put(byKeys(measured, 5, 6), 5, 6))).toMatch(/^One end is at 5/);
});
