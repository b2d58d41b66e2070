/** Which keys a command may have: none that another has in the same situation, none that cannot be typed everywhere. */
import { keysOf, type Keymap } from "@/shell/keys/keymap";
import { SHELL_COMMANDS, type ShellCommand } from "@/shell/keys/shellCommands";
import type { Command } from "./command";
import { COMMANDS } from "./table";

/** What other command has one of the keys wherever this one has them; the shell's are heard everywhere. */
export function takenBy(command: Command, keys: string, keymap: Keymap): Command | ShellCommand | null {
  const shell = SHELL_COMMANDS.find((each) => each.keys.includes(keys));
  const same = COMMANDS.find(
    (each) => each.id !== command.id && each.when === command.when && keysOf(each, keymap).includes(keys),
  );
  return shell ?? same ?? null;
}

/** Keys with which browsers close, open and reload, and those that walk from field to field. */
const BROWSERS =
  /^(Tab|Shift\+Tab|Enter|Space|Escape|F5|F11|F12|Ctrl\+(Shift\+)?[NTWRLPQ]|Ctrl\+F5|Alt\+F4|Alt\+Arrow.*)$/;
/** Letters, digits, function keys and arrows stand on every keyboard, whatever is held with them. */
const EVERYWHERE =
  /^(Ctrl\+)?(Alt\+)?(Shift\+)?([A-Z0-9]|F\d+|Arrow\w+|Delete|Backspace|Home|End|PageUp|PageDown|Insert)$/;

/** Other characters need AltGr on some keyboards, or are not there at all; the plainest few are on all of them. */
export function isTypable(keys: string): boolean {
  return !BROWSERS.test(keys) && (EVERYWHERE.test(keys) || /^[.,+\-/?!:;*=]$/.test(keys));
}
