// @vitest-environment jsdom
import { expect, test } from "vitest";
import { show, testsPages } from "@/testing/page";
import { ProgramContext, type OpenProgram } from "../state/context";
import type { Person } from "../state/presence";
import { People } from "./EditorTop";

testsPages();

/** The words of the pictures of so many people, and what is drawn in the last one. */
function pictures(count: number) {
  const people = Array.from({ length: count }, (_, at) => ({ client: at, name: `P${at}`, initials: `${at}`, me: !at }));
  const shared = { subscribeSaving: () => () => undefined, getSaving: () => LIVE };
  const t = (key: string, values: { name?: string; names?: string }) => `${key} ${values.name ?? values.names}`;
  const open = { people: people as unknown as Person[], shared, t } as unknown as OpenProgram;
  const { container, unmount } = show(
    <ProgramContext value={open}>
      <People />
    </ProgramContext>,
  );
  const all = [...container.querySelectorAll("[title]")];
  const found = { titles: all.map((each) => each.getAttribute("title")), last: all.at(-1)?.textContent };
  unmount();
  return found;
}
const LIVE = { connection: "live" };

test("six people have pictures, and all others are counted and named behind them", () => {
  const six = pictures(6);
  expect([six.titles.length, six.titles[0], six.last]).toEqual([6, "you P0", "5"]);
  const eight = pictures(8);
  expect(eight.titles.slice(0, 6)).toEqual(six.titles);
  expect([eight.titles.slice(6), eight.last]).toEqual([["people_more P6, P7"], "+2"]);
});
