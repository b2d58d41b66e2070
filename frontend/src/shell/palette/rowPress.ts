/** What takes a row of a list under a field that keeps the keyboard; a finger can scroll the list. */
export function rowPress(take: () => void) {
  return { onPointerDown: (event: Pick<Event, "preventDefault">) => event.preventDefault(), onClick: take };
}
