/** A ref: what comes in the place of something that had the keyboard takes it, so that it is read out. */
export function takeKeyboard(element: HTMLElement | null): void {
  element?.focus();
}
