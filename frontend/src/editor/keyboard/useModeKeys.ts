/** The keys within a mode: heard before the map and the lists hear them, and left to fields. */
import { useEffect, useLayoutEffect } from "react";
import { takesLetters } from "../state/focus";
import type { OpenProgram } from "../state/context";
import { useGestures } from "../state/gestures";
import { useUi } from "../state/ui";
import { leaveMode, pressInMode, useMode } from "./modes";

export function useModeKeys(open: OpenProgram): void {
  useLayoutEffect(() => {
    const press = (event: KeyboardEvent) => {
      if (!open.canEdit || useUi.getState().dialog || useGestures.getState().menu) return;
      if (!hear(open, event)) return;
      event.preventDefault();
      event.stopPropagation();
    };
    window.addEventListener("keydown", press, { capture: true });
    return () => window.removeEventListener("keydown", press, { capture: true });
  }, [open]);
  useEffect(() => () => leaveMode(), [open.program.id]);
}

function hear(open: OpenProgram, event: KeyboardEvent): boolean {
  const { mode } = useMode.getState();
  if (event.ctrlKey || event.metaKey || event.altKey) {
    // Undo and whatever else has a key of its own: the spots of before may be gone after it.
    if (mode && event.key !== "Control" && event.key !== "Meta" && event.key !== "Alt") leaveMode();
    return false;
  }
  if (takesLetters(event.target)) {
    if (mode) leaveMode();
    return false;
  }
  return mode ? pressInMode(open, mode, event) : false;
}
