// @vitest-environment jsdom
import { render } from "@testing-library/react";
import { afterEach, expect, test, vi } from "vitest";
import { useSize } from "./useSize";

afterEach(() => vi.restoreAllMocks());

function Box() {
  const [element, { width, height }] = useSize<HTMLDivElement>();
  return <div ref={element}>{`${width} x ${height}`}</div>;
}

test("a size is known before the first paint, however late the browser tells of changes", () => {
  vi.stubGlobal(
    "ResizeObserver",
    class {
      observe() {}
      disconnect() {}
    },
  );
  vi.spyOn(Element.prototype, "clientWidth", "get").mockReturnValue(480);
  vi.spyOn(Element.prototype, "clientHeight", "get").mockReturnValue(286);
  expect(render(<Box />).container.textContent).toBe("480 x 286");
});
