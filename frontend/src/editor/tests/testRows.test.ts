import { expect, test } from "vitest";
import type { Device } from "@/api/types";
import { freshThen, isWhole, rowsOf, thenEntry, valuesOf } from "./testRows";
import { readValues } from "./testText";

const TEXT = `name: All that can be expected
given: {stock: {store: {box: 24}}}
when:
  faults:
    - {fault: late, device: oven, after_s: 10, at_step: 7b.1}
    - {fault: unheard_of, device: oven}
then:
  - ends: well
  - fails: timed_out
  - within_s: 1800
  - item: {object: box, at: dropOff, count: 1}
  - item: {object: box, at: dropOff}
  - never_two_in: {zone: Corridor}
  - never_two_in: {place: dock1, within_m: 0.5}
  - commands: [mixer.mixPaint, drop]
  - commands: drop
  - property: {device: oven, name: temperature, at_least: 40}
  - step: {step: 7b.1, times: 0}
  - step: {step: 3}
  - ends: badly
  - unheard_of: {a: 1}
`;
const read = () => {
  const values = readValues(TEXT);
  if (!values) throw new Error();
  return values;
};
const stepNamed = (said: string) => (said === "7b.1" || said === "s7" ? "s7" : said === "3" ? "s3" : null);
const OVEN = { id: "oven", name: "Oven", kind: "machine", lifecycle: "approved", properties: [], methods: [] };
const around = { devices: [OVEN as unknown as Device], steps: new Set(["s3", "s7"]) };

test("each line of a text has its line in the form, and what a form does not know is kept", () => {
  const rows = rowsOf(read(), stepNamed);
  expect(rows.then.map(({ kind }) => kind)).toEqual(
    "ends fails within_s item item zone near commands commands property step step other other".split(" "),
  );
  expect(rows.then.find(({ kind }) => kind === "step")?.says).toEqual({ step: "s7", times: 0 });
  expect(rows.faults.map(({ draft }) => draft?.at_step ?? null)).toEqual(["s7", null]);
  const { given, faults, then } = read();
  expect(valuesOf(rows, around)).toEqual({ given, faults, then });
});

test("a line that was changed is written anew, and only when it has all that it needs", () => {
  const rows = rowsOf(read(), stepNamed);
  for (const row of rows.then.filter(({ kind }) => kind !== "other")) {
    const entry = thenEntry({ ...row, written: null });
    const [[kind, says] = ["", null]] = Object.entries(entry ?? {});
    if (kind === "step") expect(says).toMatchObject({ step: expect.stringMatching(/^s[37]$/) as string });
    else if (kind === "commands") expect(entry).toEqual({ commands: [row.written?.commands].flat() });
    else expect(entry).toEqual(row.written);
  }
  const fresh = (["ends", "within_s", "item", "step", "commands", "property", "zone", "near", "fails"] as const).map(
    freshThen,
  );
  expect(fresh.filter(isWhole.then).map(({ kind }) => kind)).toEqual(["ends", "within_s"]);
  const [fault] = rows.faults;
  if (!fault?.draft) throw new Error();
  const changed = { ...fault.draft, numbers: { ...fault.draft.numbers, after_s: 5 } };
  const written = (draft: typeof changed) =>
    valuesOf({ ...rows, faults: [{ draft, isTouched: true, written: null }] }, around).faults;
  expect(written(changed)).toEqual([{ fault: "late", device: "oven", after_s: 5, at_step: "s7", nth: 1 }]);
  expect(written({ ...changed, device: null })).toEqual([]);
});
