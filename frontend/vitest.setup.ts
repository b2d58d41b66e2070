import { afterAll, beforeAll, vi } from "vitest";

/** Files of tests share a browser, so that each need not make its own: what one leaves there, the next does not find. */
beforeAll(() => {
  if (typeof localStorage === "undefined") return;
  localStorage.clear();
  sessionStorage.clear();
  document.body.replaceChildren();
});

afterAll(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});
