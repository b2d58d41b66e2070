import { expect, test } from "vitest";
import cases from "../../../../tests/cases/names.json";
import { pythonName } from "./names";

test.each(Object.entries(cases.called))("%s is called as the server calls it", (name, python) => {
  expect(pythonName(name)).toBe(python);
});
