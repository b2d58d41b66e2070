import { afterAll, beforeAll, vi } from "vitest";

/** What a browser has and jsdom lacks: pages ask for it while they are loaded. Nothing matches, nothing has a size, no font comes. */
if (typeof document !== "undefined") {
  const nothing = () => undefined;
  const silent = { addEventListener: nothing, removeEventListener: nothing };
  Object.assign(globalThis, {
    matchMedia: () => ({ matches: false, ...silent }),
    ResizeObserver: class {
      observe() {}
      unobserve() {}
      disconnect() {}
    },
  });
  Object.defineProperty(document, "fonts", { configurable: true, value: { ...silent, ready: new Promise(nothing) } });
  Element.prototype.scrollIntoView = nothing;
  // Only a fault takes so long: beside the other tests, a drawing and what follows an answer take seconds.
  const { configure } = await import("@testing-library/react");
  configure({ asyncUtilTimeout: 20_000 });
}

/** Files of tests share a browser, so that each need not make its own: what one leaves there, the next does not find. */
beforeAll(() => {
  if (typeof localStorage === "undefined") return;
  localStorage.clear();
  sessionStorage.clear();
  document.body.replaceChildren();
});

/** What is still being fetched comes while this file's browser stands: else it is missing in every file behind it. */
afterAll(async () => {
  vi.useRealTimers();
  await vi.dynamicImportSettled();
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});
