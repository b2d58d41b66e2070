// @vitest-environment jsdom
import { screen } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { showAt, testsPages } from "@/testing/page";
import { CompareScreen } from "../CompareScreen";
import { FunctionCompareScreen } from "./FunctionCompareScreen";

const drawn = vi.fn((_props: object) => null);
// A module that another file's tests have fetched already, as the screen of programs may be, has none of these.
vi.mock("../ComparedParts", async (read) => ({ ...(await read<object>()), MapOf: (props: object) => drawn(props) }));
vi.mock("../ReviewBar", () => ({ ReviewBar: () => null }));
vi.mock("@/shell/TopBar", () => ({ TopBar: () => null, Crumb: () => null }));

const SIDE = { problem: "", errors: 0, document: null, compiled: null };
const SAME = { old: SIDE, new: SIDE, difference: { constructs: [], tidied: [], same: 2 } };
const ANSWERS: readonly (readonly [RegExp, unknown])[] = [
  [/\/library\/f\/sides|\/comparison\?old=draft/, SAME],
  [/\/library\/f\/comparison/, { reasons: [] }],
  [/\/library\/f/, { id: "f", name: "mix", version: 1 }],
  [/\/runs|version-tests|program=p/, []],
  [/\/review(\?|$)/, { needed: 0, number: null, history: [], why_not: "", may_run: true, compare_with: null }],
  [/\/programs\/p\/(?!compar|review)/, { items: [], next: null, copies: [], origin: null }],
  [/\/programs\/p/, { id: "p", name: "Paint", site: "hall" }],
  [/\/sites\/hall$/, { slug: "hall", name: "Hall", has_map: false, role: "viewer", stop: { active: false } }],
];

testsPages();
// Letters are measured once they are there.
Object.defineProperty(document, "fonts", { value: { ready: Promise.resolve() } });

async function said(address: string): Promise<string | null> {
  vi.stubGlobal("WebSocket", class { close() {} }); // prettier-ignore
  vi.stubGlobal("fetch", (url: string | Request) => {
    const path = typeof url === "string" ? url : url.url;
    return Promise.resolve(Response.json(ANSWERS.find(([each]) => each.test(path))?.[1] ?? []));
  });
  showAt(address, [
    { path: "/sites/:slug/library/:id/compare", Component: FunctionCompareScreen },
    { path: "/programs/:id/compare", Component: CompareScreen },
  ]);
  return (await screen.findByText(/one version|no difference|same/i, {}, { timeout: 20_000 })).textContent;
}

test("the only version of a library function is said to be one, and drawn whole", async () => {
  expect(await said("/sites/hall/library/f/compare")).toMatch(/^This is one version/);
  expect(drawn).toHaveBeenLastCalledWith(expect.objectContaining({ isOne: true }));
});

test("what is drawn now in a program without versions is said to be no version", async () => {
  expect(await said("/programs/p/compare")).not.toMatch(/^This is one version/);
});
