import { createInstance } from "i18next";
import { describe, expect, it } from "vitest";
import type { FunctionReason, NeedOfDevice } from "@/api/types";
import schema from "../../../../docs/openapi.json";
import deLibrary from "@/i18n/de/screens/library.json";
import enLibrary from "@/i18n/en/screens/library.json";
import { isBreaking, lackWords, needWords, reasonWords, valueWords } from "./libraryWords";

const i18n = createInstance();
await i18n.init({
  lng: "en",
  fallbackLng: false,
  interpolation: { escapeValue: false },
  resources: { en: { translation: { library: enLibrary } }, de: { translation: { library: deLibrary } } },
});
const t = i18n.getFixedT("en");
const LIFT: NeedOfDevice = { of: "robot", name: "robot", methods: ["lift"], gives: [], takes: ["box"], readings: [] };
const PRESS: NeedOfDevice = { of: "machine", name: "Press", methods: [], gives: [], takes: [], readings: [] };
const CODES = schema.components.schemas.ReasonShape.properties.code.enum as FunctionReason["code"][];

function reason(code: FunctionReason["code"], more: Partial<FunctionReason> = {}): FunctionReason {
  return { code, breaks: false, name: "minutes", old: "", new: "", of: "robot", ...more };
}

describe("what devices lack", () => {
  it("is told as who is wanted and what for", () => {
    expect(needWords(t, LIFT)).toBe("a robot that can lift, take box");
    expect(lackWords(t, [PRESS])).toBe("Lacks a machine such as Press");
    expect(lackWords(t, [LIFT, PRESS])).toBe("Lacks a robot that can lift, take box and 1 more");
    expect(lackWords(t, [])).toBe("");
    expect(lackWords(t, null)).toBe("");
  });
});

describe("what a newer version changes", () => {
  it.each(["en", "de"])("has a sentence for each reason and whoever it is about, in %s", (language) => {
    const say = i18n.getFixedT(language);
    for (const code of CODES)
      for (const of of ["robot", "machine", "parameter"] as const)
        expect(reasonWords(say, reason(code, { of }))).not.toContain("library.reason");
  });
  it("names units and values as people write them", () => {
    expect(reasonWords(t, reason("parameter_unit", { old: "MIN", new: "" }))).toBe(
      "minutes is in no unit now instead of min.",
    );
    const older = JSON.stringify({ quantity: [3, "MIN"] });
    expect(reasonWords(t, reason("default_changed", { old: older, new: "4" }))).toBe(
      "If left out, minutes is 4 now instead of 3 min.",
    );
  });
  it("is breaking where one thing breaks", () => {
    expect(isBreaking([reason("parameter_added"), reason("parameter_gone", { breaks: true })])).toBe(true);
    expect(isBreaking([reason("parameter_added")])).toBe(false);
    expect(isBreaking(null)).toBe(false);
  });
});

it("tells values that are no JSON as they are", () => {
  expect(valueWords("{")).toBe("{");
  expect(valueWords('{"device": "oven1"}')).toBe("oven1");
  expect(valueWords("[1, 2]")).toBe("[1,2]");
});
