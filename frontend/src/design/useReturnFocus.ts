/** For a dialog that goes when it is closed: whoever opened it by keyboard goes on from there. */
import { useEffect, useRef, useState } from "react";

/** What had the focus; of a menu, which is gone by then, the button that opens it. */
function opener(): HTMLElement | null {
  const active = document.activeElement;
  const button = active?.closest("[role=menu]")?.getAttribute("aria-labelledby");
  return button ? document.getElementById(button) : active instanceof HTMLElement ? active : null;
}

/**
 * `otherwise` finds who has the focus where what opened the dialog has gone too, such as the row of what was removed.
 * Call what is returned where that is about to go: a list is often drawn anew only after the dialog has closed.
 */
export function useReturnFocus(otherwise: () => HTMLElement | null = () => null): () => void {
  const [from] = useState(opener);
  const isGoing = useRef(false);
  useFocusAfter(() => (from?.isConnected && !isGoing.current ? from : otherwise()));
  return () => {
    isGoing.current = true;
  };
}

/** When the caller goes and takes the focus with it, what `find` finds then has it. */
export function useFocusAfter(find: () => HTMLElement | null): void {
  const last = useRef(find);
  useEffect(() => {
    last.current = find;
  });
  useEffect(
    () => () => {
      if (document.activeElement === document.body) last.current()?.focus({ preventScroll: true });
    },
    [],
  );
}
