// @vitest-environment jsdom
import { act, cleanup, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";

/** What Chromium knows of a query: it tells of a change only those who have not asked since. */
class Query {
  told: (() => void)[] = [];
  private dark = false;
  private known = false;
  get matches() {
    this.known = this.dark;
    return this.dark;
  }
  set(dark: boolean) {
    this.dark = dark;
  }
  addEventListener(_kind: string, listener: () => void) {
    this.told.push(listener);
  }
  removeEventListener(_kind: string, listener: () => void) {
    this.told = this.told.filter((each) => each !== listener);
  }
  /** The page is drawn anew. */
  draw() {
    if (this.known === this.dark) return;
    for (const each of [...this.told]) each();
  }
}

beforeEach(() => vi.resetModules());
afterEach(() => {
  cleanup();
  vi.resetModules(); // no other file's tests go on with this one's system
});

test("all parts of a page follow the system's theme, also one that is drawn before the others hear of it", async () => {
  const query = new Query();
  vi.stubGlobal("matchMedia", () => query);
  const { useTheme } = await import("./theme");
  function Part({ name }: { name: string }) {
    return <p>{`${name}: ${useTheme()}`}</p>;
  }
  render(<Part name="page" />);
  query.set(true);
  render(<Part name="menu" />);
  act(() => query.draw());
  expect(screen.getByText(/^page/).textContent).toBe("page: dark");
  expect(screen.getByText(/^menu/).textContent).toBe("menu: dark");
});
