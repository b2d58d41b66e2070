/** A finger that stays on a step asks for its menu, where the browser has no event of its own for that. */
import { useEffect } from "react";
import { useFingers } from "@/program/touch/fingers";

const HELD_MS = 500;
/** A finger is never quite still. */
const SLACK_PX = 10;

/** The finger's lift is no press of its own, which would close what it has opened. */
function quietLift(): void {
  const lifted = new AbortController();
  const quiet = (event: Event) => {
    lifted.abort();
    event.preventDefault();
  };
  const options = { capture: true, passive: false, signal: lifted.signal };
  for (const name of ["touchend", "touchcancel"]) window.addEventListener(name, quiet, options);
}

/** `ask` tells whether it has opened one. */
export function useLongPress(ask: (press: PointerEvent) => boolean): void {
  useEffect(() => {
    let held: { readonly press: PointerEvent; readonly timer: ReturnType<typeof setTimeout> } | null = null;
    const give = () => {
      if (held) clearTimeout(held.timer);
      held = null;
    };
    const begin = (press: PointerEvent) => {
      give();
      if (press.pointerType !== "touch" || !press.isPrimary) return;
      const timer = setTimeout(() => {
        held = null;
        if (useFingers.getState().several) return;
        if (ask(press)) quietLift();
      }, HELD_MS);
      held = { press, timer };
    };
    const move = (event: PointerEvent) => {
      if (held && Math.hypot(event.clientX - held.press.clientX, event.clientY - held.press.clientY) > SLACK_PX) give();
    };
    const listeners = [
      ["pointerdown", begin],
      ["pointermove", move],
      ["pointerup", give],
      ["pointercancel", give],
    ] as const;
    for (const [name, listener] of listeners) window.addEventListener(name, listener, { capture: true });
    return () => {
      give();
      for (const [name, listener] of listeners) window.removeEventListener(name, listener, { capture: true });
    };
  }, [ask]);
}
