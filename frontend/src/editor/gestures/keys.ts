/** The keys of the gestures; they are heard before the lists and the map hear them. */
import { useLayoutEffect } from "react";
import type { OpenProgram } from "../state/context";
import { isTyping } from "../state/focus";
import { useUi } from "../state/ui";
import { COMMANDS } from "./commands";

/** As in "Ctrl+Shift+G"; Cmd counts as Ctrl. */
export function nameOfKeys(event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">): string {
  const key = event.key.length === 1 ? event.key.toUpperCase() : event.key;
  const held = [
    event.ctrlKey || event.metaKey ? "Ctrl+" : "",
    event.altKey ? "Alt+" : "",
    event.shiftKey ? "Shift+" : "",
  ];
  return held.join("") + key;
}

/** Left to the browser, whose own events of them also reach the system's clipboard. */
const CLIPBOARD = ["Ctrl+C", "Ctrl+X", "Ctrl+V"];

export function useGestureKeys(open: OpenProgram): void {
  useLayoutEffect(() => {
    const press = (event: KeyboardEvent) => {
      if (useUi.getState().dialog || isTyping(event.target)) return;
      const keys = nameOfKeys(event);
      if (CLIPBOARD.includes(keys)) event.stopPropagation();
      else if (keys.startsWith("Ctrl+")) runKeys(open, keys, event);
    };
    window.addEventListener("keydown", press, { capture: true });
    return () => window.removeEventListener("keydown", press, { capture: true });
  }, [open]);
}

function runKeys(open: OpenProgram, keys: string, event: KeyboardEvent): void {
  const command = COMMANDS.find((each) => each.keys === keys);
  const { selected } = useUi.getState();
  if (!command || selected.length === 0 || !open.canEdit) return;
  command.run(open, selected);
  event.preventDefault();
  event.stopPropagation();
}
