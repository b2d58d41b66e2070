/** A page of the settings is in one table; what it lacks elsewhere is named here. */
import { expect, test } from "vitest";
import openapi from "../../../../docs/openapi.json?raw";
import de from "@/i18n/de/screens/people.json";
import en from "@/i18n/en/screens/people.json";
import { MOST_APPROVALS, MOST_DAYS } from "./bounds";
import { SETTINGS_PAGES } from "./settingsPages";

const files = Object.keys(import.meta.glob("/src/pages/*/*Page.tsx"));

/** A sentence for all that a page of the table lacks. */
function lacking(pages: readonly { name: string; file: string }[]): string[] {
  return pages.flatMap(({ name, file }) => [
    ...(files.includes(`/src/${file}.tsx`) ? [] : [`src/${file}.tsx is missing`]),
    ...(name in en.tab ? [] : [`en/screens/people.json lacks tab.${name}`]),
    ...(name in de.tab ? [] : [`de/screens/people.json lacks tab.${name}`]),
  ]);
}

test("each page of the settings has its file and the word on its tab", () => {
  expect(files.length).toBeGreaterThan(15);
  expect(lacking(SETTINGS_PAGES)).toEqual([]);
});

test("what a new page lacks is named with the file", () => {
  expect(lacking([{ name: "noise", file: "pages/settings/NoisePage" }])).toEqual([
    "src/pages/settings/NoisePage.tsx is missing",
    "en/screens/people.json lacks tab.noise",
    "de/screens/people.json lacks tab.noise",
  ]);
});

interface Schema {
  properties: Record<string, { maximum?: number; anyOf?: { maximum?: number }[] }>;
}

test("what people may set is bounded as the API bounds it", () => {
  const { schemas } = (JSON.parse(openapi) as { components: { schemas: Record<string, Schema> } }).components;
  const most = (shape: string, field: string) => {
    const found = schemas[shape]?.properties[field];
    return found?.maximum ?? found?.anyOf?.[0]?.maximum;
  };
  expect(most("SetReviewRule", "approvals")).toBe(MOST_APPROVALS);
  expect(["runs", "rehearsals", "calls"].map((kind) => most("SetKeeping", kind))).toEqual(Array(3).fill(MOST_DAYS));
});
