// @vitest-environment jsdom
import { expect, test } from "vitest";
import { walk } from "./StaticMap";

test("the arrow keys lead from device to device and round, other keys nowhere", () => {
  document.body.innerHTML = ["a", "b", "c"]
    .map((id) => `<b id="${id}" role="button" tabindex="-1"></b>`)
    .join("<i></i>");
  const at = (id: string) => document.getElementById(id) as HTMLElement;
  const after = (id: string, key: string) => (walk(at(id), key) ? document.activeElement?.id : null);
  expect(after("a", "ArrowRight")).toBe("b");
  expect(after("c", "ArrowDown")).toBe("a");
  expect(after("a", "ArrowUp")).toBe("c");
  expect(after("b", "Home")).toBe("a");
  expect(after("b", "End")).toBe("c");
  expect(after("b", "x")).toBeNull();
});
