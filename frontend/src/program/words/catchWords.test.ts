import { expect, test } from "vitest";
import { takenBy } from "./catchWords";
import type { Step } from "../document/document";

const step = (kind: string, place: Step["place"], params: Step["params"] = {}): Step => ({
  kind,
  place,
  pos: [0, 0],
  params,
});

test("several catches are called by what they take", () => {
  const t = (key: string) => key.replace("caught.", "");
  const several = step("try", null, { kinds: [], kinds2: ["offline"], kinds3: ["failed", "blocked"], kinds4: [] });
  const words = ["catch", "catch2", "catch3", "catch4", "finally"].map((branch) => takenBy(branch, several, t));
  expect(words).toEqual(["any", "offline", "failed +1", "rest", null]);
  expect(takenBy("catch", step("try", null, { kinds: ["failed"] }), t)).toBeNull();
});
