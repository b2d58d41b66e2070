/** Undo of one's own last gesture; where somebody changed the same field since, it asks first. */
import { changedSince } from "../model/undoing";
import type { OpenProgram } from "../state/context";
import { say } from "../state/ui";

export function undoLast({ shared, t }: Pick<OpenProgram, "shared" | "t">): void {
  if (changedSince(shared.getDocument(), shared.lastEdits())) say(t("gesture.overwritten"), true);
  else shared.undo.undo();
}
