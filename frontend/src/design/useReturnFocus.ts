/** For a dialog that goes when it is closed: whoever opened it by keyboard goes on from there. */
import { useEffect, useState } from "react";

/** What had the focus; of a menu, which is gone by then, the button that opens it. */
function opener(): HTMLElement | null {
  const active = document.activeElement;
  const button = active?.closest("[role=menu]")?.getAttribute("aria-labelledby");
  return button ? document.getElementById(button) : active instanceof HTMLElement ? active : null;
}

export function useReturnFocus(): void {
  const [from] = useState(opener);
  useEffect(
    () => () => {
      if (document.activeElement === document.body) from?.focus({ preventScroll: true });
    },
    [from],
  );
}
