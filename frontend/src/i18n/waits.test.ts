import i18next from "i18next";
import { beforeEach, expect, test } from "vitest";
import de from "./de/run.json";
import en from "./en/run.json";
import { waitWords } from "./waits";

const NAMES: Readonly<Record<string, string>> = { tb1: "Turtle 1", tb2: "Turtle 2", door1: "Gate" };
const nameOf = (device: string) => NAMES[device] ?? device;
const ARGS = {
  device: "door1",
  robot: "tb1",
  run: "run 12",
  others: "tb2,tb1",
  zone: "Lane",
  condition: "its battery above 20 %",
};

beforeEach(() =>
  i18next.init({
    lng: "en",
    resources: { de: { translation: { run: de } }, en: { translation: { run: en } } },
    interpolation: { escapeValue: false },
  }),
);

test.each(["en", "de"])("in %s every reason for waiting says all that it is told", async (language) => {
  await i18next.changeLanguage(language);
  const sentences = Object.entries(language === "de" ? de.waits : en.waits).filter(([code]) => code !== "and");
  for (const [code, sentence] of sentences) {
    const said = waitWords({ code: code.replace(/_for$/, ""), args: ARGS }, nameOf) ?? "";
    const told: Record<string, string> = { ...ARGS, device: "Gate", robot: "Turtle 1" };
    for (const [, name = ""] of sentence.matchAll(/{{(\w+)}}/g)) {
      if (name === "run" || name === "others") continue;
      expect(said, code).toContain(told[name]);
    }
    expect(said, code).not.toContain("{{");
  }
});

test("a robot with a condition is waited for with that condition", () => {
  expect(waitWords({ code: "no_fitting_robot", args: { condition: ARGS.condition } }, nameOf)).toBe(
    "Waits for a robot that can do this to be free and online, with its battery above 20 %.",
  );
});

test("a reason that the screens do not know is left to the server's sentence", () => {
  expect(waitWords({ code: "another_planet", args: {} }, nameOf)).toBeNull();
});
