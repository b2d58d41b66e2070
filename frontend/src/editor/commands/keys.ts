/** From keys to commands: one listener for all of them. */
import { useLayoutEffect } from "react";
import i18next from "i18next";
import { keysOf, useKeymap, type Keymap } from "@/shell/keys/keymap";
import { HELD_KEYS, nameOfKeys } from "@/shell/keys/keyNames";
import type { OpenProgram } from "../state/context";
import { isTyping, takesLetters } from "../state/focus";
import { say, useUi } from "../state/ui";
import { holds, selection, SITUATIONS, type Command, type Situation } from "./command";
import { COMMANDS } from "./table";

export { runCommand } from "./command";

/** The command that the keys mean now: the one of the narrowest situation that holds. */
export function commandOfKeys(
  keys: string,
  keymap: Keymap,
  isNow: (situation: Situation) => boolean,
): Command | undefined {
  const having = COMMANDS.filter((each) => keysOf(each, keymap).includes(keys));
  for (const situation of SITUATIONS) {
    const found = isNow(situation) ? having.find((each) => each.when === situation) : undefined;
    if (found) return found;
  }
  // Better told that something must be selected first than the browser's own meaning of the keys.
  return keys.startsWith("Ctrl+") ? having[0] : undefined;
}

/** Keys with Ctrl are heard before the lists and the map hear them, all others after them. */
export function useCommandKeys(open: OpenProgram): void {
  // Before the next key is heard: what is on the screen and what the keys mean change together.
  useLayoutEffect(() => {
    const first = (event: KeyboardEvent) => press(open, event, true);
    const last = (event: KeyboardEvent) => press(open, event, false);
    window.addEventListener("keydown", first, { capture: true });
    window.addEventListener("keydown", last);
    return () => {
      window.removeEventListener("keydown", first, { capture: true });
      window.removeEventListener("keydown", last);
    };
  }, [open]);
}

function press(open: OpenProgram, event: KeyboardEvent, first: boolean): void {
  if (event.defaultPrevented || HELD_KEYS.includes(event.key) || isElsewhere(event)) return;
  const keys = nameOfKeys(event);
  if (keys.startsWith("Ctrl+") !== first) return;
  const command = commandOfKeys(keys, useKeymap.getState(), holds);
  // Left to the browser, whose own events of them also reach the system's clipboard.
  if (command?.byBrowser) event.stopPropagation();
  else if (command && runByKeys(open, command, keys, event.target)) {
    event.preventDefault();
    event.stopPropagation();
  }
}

/** Letters, and letters with Ctrl, pass where nothing is written; all other keys belong to the field. */
function isElsewhere(event: KeyboardEvent): boolean {
  if (useUi.getState().dialog || event.isComposing) return true;
  if (event.target instanceof Element && event.target.closest("[aria-modal=true], [role=menu]")) return true;
  const letter = event.key.length === 1 && event.key !== " " && !event.altKey;
  return letter ? takesLetters(event.target) : isTyping(event.target);
}

function runByKeys(open: OpenProgram, command: Command, keys: string, target: EventTarget | null): boolean {
  const on = { ...selection(), keys, target };
  const reason = command.whyNot(open, on);
  if (reason === null) return command.run(open, on) !== false;
  say(i18next.t(reason));
  return true;
}
