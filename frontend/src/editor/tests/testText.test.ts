import { expect, test } from "vitest";
import { readValues, writeValues } from "./testText";

const TEXT = `# Why this test is here
name: The box comes out scratched
given:
  stock: {itemInventory01: {box: 24}}
  readings:
    curingOven01:
      temperature: 22 # as in the morning
when:
  seed: 0
  faults:
    - {fault: wrong_value, device: curingOven01, property: quality, value: scratched}
    - fault: late # the mixer is old
      device: paintMixer01
      after_s: 10
then:
  - ends: well
  - step: {step: 7b.1, times: 1}
  # What it is for:
  - item: {object: box, at: dropOff01, count: 1}
`;

test("what a text says is there for the form", () => {
  expect(readValues(TEXT)).toEqual({
    name: "The box comes out scratched",
    given: [
      { kind: "stock", device: "itemInventory01", name: "box", value: 24 },
      { kind: "readings", device: "curingOven01", name: "temperature", value: 22 },
    ],
    seed: 0,
    driver: null,
    limit_s: null,
    parameters: {},
    faults: [
      { fault: "wrong_value", device: "curingOven01", property: "quality", value: "scratched" },
      { fault: "late", device: "paintMixer01", after_s: 10 },
    ],
    then: [
      { ends: "well" },
      { step: { step: "7b.1", times: 1 } },
      { item: { object: "box", at: "dropOff01", count: 1 } },
    ],
  });
});

test("what no form can show is left to the text", () => {
  for (const text of ["", "- 1", "name: [", "given: 3", "given: {stock: {a: 3}}", "then: [well]", "when: {faults: {}}"])
    expect(readValues(text), text).toBeNull();
  expect(readValues("name: x\ngiven:\nwhen:\nthen:\n- ends: well\n")?.given).toEqual([]);
});

test("the same values are the same text", () => {
  const values = readValues(TEXT);
  expect(values && writeValues(TEXT, values)).toBe(TEXT);
});

test("one changed value changes its place alone, and comments stay", () => {
  const values = readValues(TEXT);
  if (!values) throw new Error();
  const [wrong, late] = values.faults;
  expect(writeValues(TEXT, { faults: [wrong ?? {}, { ...late, after_s: 25 }] })).toBe(
    TEXT.replace("after_s: 10", "after_s: 25"),
  );
  expect(writeValues(TEXT, { name: "Yes" })).toBe(TEXT.replace("The box comes out scratched", '"Yes"'));
  const warm = values.given.map((each) => (each.name === "temperature" ? { ...each, value: 40 } : each));
  expect(writeValues(TEXT, { given: warm })).toBe(TEXT.replace("temperature: 22 #", "temperature: 40 #"));
});

test("lines come and go, and what holds nothing any more goes with the last of them", () => {
  const values = readValues(TEXT);
  if (!values) throw new Error();
  const without = writeValues(TEXT, { given: [], faults: values.faults.slice(1), then: values.then.slice(1) });
  expect(without).not.toContain("given");
  expect(without).not.toContain("wrong_value");
  expect(without).not.toContain("ends");
  expect(without).toContain("# the mixer is old");
  expect(without).toContain("# What it is for:");
  const more = writeValues(without, {
    given: [{ kind: "carrying", device: "robot01", name: "box", value: 2 }],
    faults: [],
    seed: 7,
    then: [...values.then, { within_s: 60 }],
  });
  const read = readValues(more);
  expect(read?.given).toEqual([{ kind: "carrying", device: "robot01", name: "box", value: 2 }]);
  expect(read).toMatchObject({ faults: [], seed: 7 });
  expect(read?.then).toEqual([...values.then, { within_s: 60 }]);
});

test("a test that says nothing yet is filled in", () => {
  const text = writeValues("name: New\nthen:\n- ends: well\n", {
    faults: [{ fault: "drops", device: "robot01", odds: 0.05 }],
    driver: "physics",
    parameters: { count: 3 },
  });
  expect(readValues(text)).toMatchObject({ driver: "physics", parameters: { count: 3 }, name: "New" });
  expect(text).toContain("then:\n- ends: well\n");
  expect(writeValues(text, { driver: null, parameters: {}, faults: [] })).toBe("name: New\nthen:\n- ends: well\n");
});
