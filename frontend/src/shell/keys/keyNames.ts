/** Keys by what they write, not by where they lie, so that every keyboard has them: "Ctrl+Shift+G", "Shift+B", "/". */

export type KeyPress = Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey"> & {
  readonly getModifierState?: (key: string) => boolean;
};

/**
 * As in "Ctrl+Shift+G"; Cmd counts as Ctrl. Shift is not named where it only made the character: "?" is "?" on every
 * keyboard, whatever was held for it. The same goes for AltGr, which some systems tell as Ctrl and Alt.
 */
export function nameOfKeys(event: KeyPress): string {
  const character = event.key.length === 1;
  const letter = character && event.key.toLowerCase() !== event.key.toUpperCase();
  const third = character && (event.getModifierState?.("AltGraph") ?? false);
  const held = [
    (event.ctrlKey || event.metaKey) && !third ? "Ctrl+" : "",
    event.altKey && !third ? "Alt+" : "",
    event.shiftKey && (letter || !character) ? "Shift+" : "",
  ];
  return held.join("") + (event.key === " " ? "Space" : character ? event.key.toUpperCase() : event.key);
}

/** A key that writes: it can be pressed by mistake, or by somebody who dictates (WCAG 2.1.4). */
export function isCharacterKey(keys: string): boolean {
  return keys.length === 1 || /^Shift\+.$/u.test(keys);
}

/** Keys that do nothing by themselves. */
export const HELD_KEYS: readonly string[] = ["Control", "Shift", "Alt", "Meta", "AltGraph", "CapsLock", "Dead"];

const SIGNS: Readonly<Record<string, string>> = {
  ArrowUp: "↑",
  ArrowDown: "↓",
  ArrowLeft: "←",
  ArrowRight: "→",
};

/** How a keyboard of this language has it printed: "Ctrl+Shift+↑", "Strg+Umschalt+↑". */
export function wordsOfKeys(keys: string, word: (key: string) => string): string {
  // The last part may be a plus itself.
  const parts = keys.endsWith("+") ? [...keys.slice(0, -1).split("+").filter(Boolean), "+"] : keys.split("+");
  return parts.map((part) => SIGNS[part] ?? (part.length > 1 ? word(part) : part)).join("+");
}

/** As `aria-keyshortcuts` wants it. */
export function ariaKeys(keys: readonly string[]): string | undefined {
  return keys.length === 0 ? undefined : keys.map((each) => each.replace("Ctrl+", "Control+")).join(" ");
}
