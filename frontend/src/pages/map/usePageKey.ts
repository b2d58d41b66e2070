/** A key of a whole page, wherever the focus is. */
import { useEffect, useRef } from "react";

/** What letters are written into; a switch or a row of choices has no use for them. */
const TEXTS =
  "input:not([type=checkbox], [type=radio], [type=range], [type=file]), textarea, select, [contenteditable=true], [role=listbox]";

/** `key` as the event names it, a letter small; `act` is called at each press that means nothing else, if it `isOn`. */
export function usePageKey(key: string, act: () => void, isOn = true): void {
  const latest = useRef(act);
  useEffect(() => {
    latest.current = act;
  });
  useEffect(() => {
    if (!isOn) return;
    const press = (event: KeyboardEvent) => {
      const pressed = event.key.length === 1 ? event.key.toLowerCase() : event.key;
      if (pressed !== key || isHeld(event) || isTaken(event.target)) return;
      event.preventDefault();
      latest.current();
    };
    // Before a menu hears it, which would be gone by then.
    window.addEventListener("keydown", press, { capture: true });
    return () => window.removeEventListener("keydown", press, { capture: true });
  }, [key, isOn]);
}

const isHeld = (event: KeyboardEvent): boolean =>
  event.ctrlKey || event.metaKey || event.altKey || event.shiftKey || event.repeat || event.isComposing;

/** Whoever types, chooses from a menu or answers a dialog means that. */
function isTaken(target: EventTarget | null): boolean {
  return (
    (target instanceof Element && target.matches(TEXTS)) ||
    document.querySelector("[role=dialog], [role=alertdialog], [role=menu]") !== null
  );
}
