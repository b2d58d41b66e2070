/** A pasted text that is script; what reads it is a script of its own, which nobody waits for. */
import { looksLikeScript } from "../script/scriptLines";
import type { OpenProgram } from "../state/context";
import { say } from "../state/ui";

export const loadPasting = () => import("../script/pastedScript");

/** Take a pasted text for script, if it looks like it; says so where what reads it cannot be fetched by `load`. */
export function pasteIfScript(open: OpenProgram, text: string, load = loadPasting): boolean {
  const isScript = looksLikeScript(text);
  if (isScript)
    void load().then(
      ({ pasteScript }) => pasteScript(open, text),
      () => say(open.t("script.paste_unloaded")),
    );
  return isScript;
}
