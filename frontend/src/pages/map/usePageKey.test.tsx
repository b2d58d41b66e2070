// @vitest-environment jsdom
import { act } from "react";
import { createRoot } from "react-dom/client";
import { beforeEach, expect, test, vi } from "vitest";
import { usePageKey } from "./usePageKey";

const toggle = vi.fn();

function Page() {
  usePageKey("m", toggle);
  return (
    <>
      <button type="button">b</button>
      <input aria-label="i" />
    </>
  );
}

beforeEach(() => {
  Object.assign(globalThis, { IS_REACT_ACT_ENVIRONMENT: true });
  document.body.innerHTML = "<main></main>";
  toggle.mockReset();
});

function shown() {
  const main = document.querySelector("main") as HTMLElement;
  const root = createRoot(main);
  act(() => root.render(<Page />));
  return () => act(() => root.unmount());
}

function press(where: string, key: string, held: KeyboardEventInit = {}) {
  const event = new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...held });
  document.querySelector(where)?.dispatchEvent(event);
  return event.defaultPrevented;
}

test("a letter is heard from everywhere, small or large, until the page goes", () => {
  const leave = shown();
  expect([press("body", "m"), press("button", "M")]).toEqual([true, true]);
  expect(toggle).toHaveBeenCalledTimes(2);
  leave();
  press("body", "m");
  expect(toggle).toHaveBeenCalledTimes(2);
});

test("it is left to who types, to other keys, and to what is held with it", () => {
  const leave = shown();
  press("input", "m");
  press("body", "n");
  for (const held of [{ ctrlKey: true }, { metaKey: true }, { altKey: true }, { shiftKey: true }, { repeat: true }])
    expect(press("body", "m", held)).toBe(false);
  expect(toggle).not.toHaveBeenCalled();
  leave();
});

test("it is left to a dialog and to a menu while one is open", () => {
  const leave = shown();
  for (const role of ["dialog", "alertdialog", "menu"]) {
    const open = document.createElement("div");
    open.setAttribute("role", role);
    document.body.append(open);
    press("body", "m");
    open.remove();
  }
  expect(toggle).not.toHaveBeenCalled();
  press("body", "m");
  expect(toggle).toHaveBeenCalledOnce();
  leave();
});
