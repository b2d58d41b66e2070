/** Keys that every page hears: they are in the editor's list of keys, too, and nothing else may have them. */

export interface ShellCommand {
  readonly id: "palette" | "stop";
  readonly words: { readonly name: string };
  readonly keys: readonly string[];
  readonly fixed: true;
}

export const PALETTE: ShellCommand = {
  id: "palette",
  words: { name: "commands.palette.name" },
  keys: ["Ctrl+K"],
  fixed: true,
};

/** By the key that has the full stop, or by that character: on some keyboards it is not the same key. */
export const STOP: ShellCommand = {
  id: "stop",
  words: { name: "commands.stop.name" },
  keys: ["Ctrl+Shift+."],
  fixed: true,
};

export const SHELL_COMMANDS: readonly ShellCommand[] = [PALETTE, STOP];
