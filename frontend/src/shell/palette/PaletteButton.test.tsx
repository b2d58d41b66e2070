// @vitest-environment jsdom
import { act, fireEvent, renderHook, screen } from "@testing-library/react";
import { afterEach, beforeAll, expect, test, vi } from "vitest";
import { show, testsPages } from "@/testing/page";
import { useTypedAhead } from "../keys/typedAhead";
import { PaletteButton } from "./PaletteButton";

/** Only a fault takes so long. */
const LONG_MS = 30_000;

testsPages();
/** Keys are kept for ten seconds, and beside the other tests a first fetch may take longer. The window comes late all the same. */
beforeAll(() => import("./Palette"));
const heard = vi.fn();
const onKey = ({ key }: KeyboardEvent) => void heard(key);
afterEach(() => {
  window.removeEventListener("keydown", onKey);
  heard.mockClear();
});

function ask() {
  vi.stubGlobal("fetch", () => Promise.resolve(Response.json([])));
  show(<PaletteButton slug={undefined} />);
  window.addEventListener("keydown", onKey);
  fireEvent.keyDown(document.body, { key: "k", ctrlKey: true });
  heard.mockClear();
}
const press = (...keys: string[]) => keys.forEach((key) => fireEvent.keyDown(document.body, { key }));

test("what is typed before the palette is there stands in its field, and the page hears none of it", async () => {
  ask();
  press("w", "a", "x", "Backspace", "i", "t", "Enter");
  const field = await screen.findByRole("combobox", {}, { timeout: LONG_MS });
  await vi.waitFor(() => expect(document.activeElement).toBe(field), LONG_MS);
  expect(heard).not.toHaveBeenCalled();
  expect((field as HTMLInputElement).value).toBe("wait");
  press("p");
  expect(heard).toHaveBeenCalledWith("p");
});

test("the browser's keys are heard by all, and the asking key that is still held is not typed", async () => {
  ask();
  press("F5", "Tab", "F12");
  expect(heard.mock.calls).toEqual([["F5"], ["Tab"], ["F12"]]);
  const hold = (key: string) => fireEvent.keyDown(document.body, { key, repeat: true });
  ["k", "k"].forEach(hold);
  press("F");
  hold("F");
  expect(heard).toHaveBeenCalledTimes(3);
  const field = await screen.findByRole("combobox", {}, { timeout: LONG_MS });
  await vi.waitFor(() => expect((field as HTMLInputElement).value).toBe("FF"), LONG_MS);
});

test("a window that does not come leaves the keys to the page", () => {
  vi.useFakeTimers();
  try {
    renderHook(() => useTypedAhead(true, () => {}));
    window.addEventListener("keydown", onKey);
    press("p");
    expect(heard).not.toHaveBeenCalled();
    vi.advanceTimersByTime(10_000);
    press("q");
    expect(heard.mock.calls).toEqual([["q"]]);
  } finally {
    vi.useRealTimers();
  }
});

test("Escape before the palette is there asks for none, and the page has its keys again", async () => {
  ask();
  press("Escape");
  press("p");
  expect(heard.mock.calls).toEqual([["p"]]);
  await act(() => import("./Palette"));
  expect(screen.queryByRole("combobox")).toBeNull();
});
