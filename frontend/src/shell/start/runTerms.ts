/** The terms on which a run is started: how much it matters, when it may begin, by when it should be over. */
import type { RunSummary } from "@/api/types";

export type Priority = RunSummary["priority"];
export const PRIORITIES: readonly Priority[] = ["low", "normal", "high"];

/** What the form says; times as inputs of the browser have them, in its own time zone, empty for none. */
export interface TermsForm {
  readonly priority: Priority;
  readonly notBefore: string;
  readonly deadline: string;
}

export const USUAL: TermsForm = { priority: "normal", notBefore: "", deadline: "" };

/** The terms for the server; only what differs from the usual. Null while a time is none. */
export function termsToSend(form: TermsForm): Record<string, string> | null {
  const times = [momentOf(form.notBefore), momentOf(form.deadline)] as const;
  if (times.includes(null)) return null;
  const [notBefore, deadline] = times;
  return {
    ...(form.priority === "normal" ? {} : { priority: form.priority }),
    ...(notBefore ? { not_before: notBefore } : {}),
    ...(deadline ? { deadline } : {}),
  };
}

/** `2026-11-23T14:30` of the browser's time zone as a moment of all; empty stays empty, nonsense is null. */
function momentOf(local: string): string | null {
  if (!local) return "";
  const at = new Date(local);
  return Number.isNaN(at.getTime()) ? null : at.toISOString();
}
