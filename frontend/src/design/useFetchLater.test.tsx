// @vitest-environment jsdom
import { cleanup, render, waitFor } from "@testing-library/react";
import { Suspense } from "react";
import { afterEach, expect, test } from "vitest";
import { beside } from "./useFetchLater";

afterEach(cleanup);

/** The page, on which there is something beside the map. */
function show(fetch: () => Promise<() => React.ReactNode>): HTMLElement {
  const Part = beside(fetch);
  return render(
    <Suspense fallback="waits">
      map
      <Part />
    </Suspense>,
  ).container;
}

test("a part beside the others is there once it is fetched", async () => {
  const page = show(() => Promise.resolve(() => " and card"));
  expect(page.textContent).toBe("waits");
  await waitFor(() => expect(page.textContent).toBe("map and card"));
});

test("without one that cannot be fetched the others are there all the same", async () => {
  const page = show(() => Promise.reject(new Error("no network")));
  expect(page.textContent).toBe("waits");
  await waitFor(() => expect(page.textContent).toBe("map"));
});
