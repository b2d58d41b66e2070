/** What a thread is about, in the words of who looks. */
import type { Thread } from "@/api/types";
import type { OpenProgram } from "../state/context";

type Known = Pick<OpenProgram, "document" | "compiled" | "t">;

/** The number and kind of a step that the program has: `2 Pick-and-Drop`. */
export function stepLabel({ document, compiled, t }: Known, id: string): string | null {
  const step = document.steps[id];
  return step ? [compiled?.numbers[id], t(`kind.${step.kind}`)].filter(Boolean).join(" ") : null;
}

/** As the program calls it now; what is gone keeps the words with which the thread began. */
export function aboutOf(open: Known, { anchor, label }: Thread): string {
  const step = anchor.kind === "construct" && anchor.root === "steps" ? stepLabel(open, anchor.id ?? "") : null;
  return step ?? (label || open.t("comments.program"));
}
