import { expect, test } from "vitest";
import { lyingAt } from "./obstacles";

const thing = (t: number, until: number | null) => ({ t, until, x: 1, y: 2, size_m: 0.5 });

test("a thing lies on the floor from its moment until it is taken away, or to the end", () => {
  const things = [thing(2, 5), thing(4, null)];
  expect([0, 2, 4.9, 5, 1000].map((t_s) => lyingAt(things, t_s))).toEqual(["", "0", "0,1", "1", "1"]);
});
