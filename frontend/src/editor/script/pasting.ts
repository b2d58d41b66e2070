/** Script pasted on the map becomes steps: one gesture, one entry to undo. */
import { api, ApiProblem } from "@/api/client";
import { makeId } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { say, select, useUi } from "../state/ui";
import { differenceOf, withFreshIds } from "./difference";
import { scriptWith } from "./pasteScript";
import type { DrawnScript } from "./session";

/** Draw the pasted lines behind the selected step, or say why that cannot be. */
export async function pasteScript(open: OpenProgram, pasted: string): Promise<void> {
  const { compiled, shared, program, devices, t } = open;
  if (!compiled) return;
  const behind = useUi.getState().selected.at(-1) ?? null;
  const text = scriptWith(pasted, compiled, behind, devices);
  if (text === null) return;
  const base = shared.getDocument();
  try {
    const request = { text, base, shown: compiled.script };
    const drawn = await api.post<DrawnScript>(`/programs/${encodeURIComponent(program.id)}/script`, request);
    if (!drawn.document) {
      say(drawn.diagnostics[0]?.message ?? t("script.paste_again"));
      return;
    }
    const { document } = withFreshIds({ document: drawn.document, lines: drawn.lines }, base, makeId);
    shared.apply(differenceOf(base, document));
    select(Object.keys(document.steps).filter((id) => !base.steps[id]));
  } catch (error) {
    if (!(error instanceof ApiProblem)) throw error;
    say(error.detail);
  }
}
