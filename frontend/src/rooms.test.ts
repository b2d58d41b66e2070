/** The frontend's rooms stay small enough to find one's way: few modules in a folder, no long module. */
import { expect, test } from "vitest";

const MOST_MODULES = 20;
const MOST_LINES = 400;
const sources = import.meta.glob<string>(["./**/*.{ts,tsx}", "!./api/schema.ts"], {
  eager: true,
  query: "?raw",
  import: "default",
});
const modules = Object.entries(sources).filter(([path]) => !/\.test\.tsx?$/.test(path));

test("no folder holds more than 20 modules", () => {
  const counts = new Map<string, number>();
  for (const [path] of modules) {
    const folder = path.slice(0, path.lastIndexOf("/"));
    counts.set(folder, (counts.get(folder) ?? 0) + 1);
  }
  expect([...counts].filter(([, count]) => count > MOST_MODULES)).toEqual([]);
  expect(modules.length).toBeGreaterThan(300);
});

test("no module has more than 400 lines", () => {
  const long = modules.filter(([, text]) => text.split("\n").length - 1 > MOST_LINES);
  expect(long.map(([path]) => path)).toEqual([]);
});

test("a test stands beside the module that it tests, or names what several do together", () => {
  const together = [
    "agreement",
    "rooms",
    "cases",
    "constructs",
    "concurrency",
    "catalogues",
    "offline",
    "answers",
    "closedBefore",
    "focus",
    "unseen",
    "lists",
  ];
  const names = new Set(modules.map(([path]) => path.replace(/\.tsx?$/, "")));
  const tests = Object.keys(sources)
    .filter((path) => /\.test\.tsx?$/.test(path))
    .map((path) => path.replace(/\.test\.tsx?$/, ""));
  const alone = tests.filter((path) => !names.has(path) && !together.includes(path.slice(path.lastIndexOf("/") + 1)));
  expect(alone).toEqual([]);
});
