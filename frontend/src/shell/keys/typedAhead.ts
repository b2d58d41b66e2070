/** What is typed between asking for a window and its being there: nobody else hears it, and its field has it. */
import { useLayoutEffect } from "react";

const WINDOW = "[aria-modal=true]";
/** A window that does not come within this time, as without a network, leaves the keys to the page. */
const PATIENCE_MS = 10_000;

function isInWindow(target: EventTarget | null): target is Element {
  return target instanceof Element && target.closest(WINDOW) !== null;
}

/** Stop all and what else goes with Ctrl are no text, nor are the keys of the browser. */
function isNoText(event: KeyboardEvent): boolean {
  return event.ctrlKey || event.metaKey || event.altKey || /^(F\d+|Tab)$/.test(event.key);
}

/** `giveUp` is the same each time: Escape asks for no window any more. */
export function useTypedAhead(asked: boolean, giveUp: () => void): void {
  useLayoutEffect(() => {
    if (!asked) return;
    let typed = "";
    const end = new AbortController();
    const listen = { capture: true, signal: end.signal };
    const hear = (event: KeyboardEvent) => {
      if (isInWindow(event.target) || isNoText(event)) return;
      if (event.key === "Escape") giveUp();
      // The key that asks may still be held.
      if (typed || !event.repeat)
        typed = event.key === "Backspace" ? typed.slice(0, -1) : typed + (event.key.length === 1 ? event.key : "");
      event.preventDefault();
      event.stopImmediatePropagation();
    };
    const take = ({ target }: FocusEvent) => {
      if (!isInWindow(target)) return;
      end.abort();
      putInto(target, typed);
    };
    window.addEventListener("keydown", hear, listen);
    window.addEventListener("focusin", take, listen);
    setTimeout(() => end.abort(), PATIENCE_MS);
    return () => end.abort();
  }, [asked, giveUp]);
}

/** As if it were typed there. */
function putInto(field: Element, typed: string): void {
  if (!typed || !(field instanceof HTMLInputElement) || field.readOnly || field.selectionStart === null) return;
  field.setRangeText(typed, field.selectionStart, field.selectionEnd ?? field.selectionStart, "end");
  field.dispatchEvent(new Event("input", { bubbles: true }));
}
