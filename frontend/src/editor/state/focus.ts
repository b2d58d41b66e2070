/** Who has the keyboard: one at a time, the map where nobody else wants it. */

const NO_TEXT = ["checkbox", "radio", "range", "button", "submit", "reset", "color", "file"];
const FIELDS = "input, textarea, select, [role=combobox], [role=listbox]";

/** The keys go to the drawing again; what the field before had to say, it says while it is left. */
export function focusMap(): void {
  const map = document.querySelector<HTMLElement>("[data-map]");
  if (map) map.focus({ preventScroll: true });
  else if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
}

/** Whether keys that move, delete or confirm belong to what has the keyboard. */
export function isTyping(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  return target.isContentEditable || target.closest(FIELDS) !== null;
}

/** Whether letters do: a switch, a row of choices and a closed list have no use for them. */
export function takesLetters(target: EventTarget | null): boolean {
  if (!isTyping(target)) return false;
  if (!(target instanceof HTMLInputElement)) return true;
  if (target.readOnly) return target.getAttribute("aria-expanded") === "true";
  return !NO_TEXT.includes(target.type);
}
