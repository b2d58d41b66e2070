import i18next from "i18next";
import { beforeAll, describe, expect, it } from "vitest";
import type { Finding } from "@/api/types";
import de from "@/i18n/de/operations.json";
import en from "@/i18n/en/operations.json";
import { findingWords, gravest, seesOperations } from "./findings";

const apart = (seconds: number): Finding => ({
  code: "clock_apart",
  severity: "error",
  text: "As the server says it.",
  args: { kind: "worker", name: "worker-2", machine: "edge", seconds },
});

describe("what is wrong with processes", () => {
  beforeAll(() =>
    i18next.init({
      lng: "en",
      resources: { de: { translation: { operations: de } }, en: { translation: { operations: en } } },
      interpolation: { escapeValue: false },
    }),
  );

  it("is said in both languages, a clock by which way it is off", async () => {
    await i18next.changeLanguage("en");
    expect(findingWords(apart(-61.3))).toBe(
      "The clock of Worker worker-2 is 61.3\u202fs behind the database's. Set the clock of edge.",
    );
    expect(findingWords(apart(2.5))).toContain("2.5\u202fs ahead");
    await i18next.changeLanguage("de");
    expect(findingWords(apart(2.5))).toContain("geht gegenüber der Uhr der Datenbank 2,5\u202fs vor");
  });

  it("is said as the server says it where this page does not know it yet", () => {
    const later = { ...apart(1), code: "of_a_later_version" } as unknown as Finding;
    expect(findingWords(later)).toBe("As the server says it.");
  });

  it("is told on every screen only when it is grave, and never to viewers", () => {
    expect(gravest([{ ...apart(3), severity: "warning" }, apart(4)])).toEqual([apart(4)]);
    expect((["viewer", "commenter", "operator", "author", "admin"] as const).filter(seesOperations)).toHaveLength(3);
    expect(seesOperations(undefined)).toBe(false);
  });
});
