/** A line of a run's journal in the language of the screen; what has no words of its own is shown as it was written. */
import i18next from "i18next";
import type { Cause, RunEvent } from "@/api/types";
import { reasonWords } from "@/i18n/reasons";
import { waitWords } from "@/i18n/waits";

export function eventWords(event: RunEvent, nameOf: (device: string) => string): string {
  const { robot, device, args } = event;
  if (event.kind === "wait" && event.code !== "wait_over") {
    const reason = { code: event.code, args: { ...scalars(args), robot, device } };
    return waitWords(reason, nameOf) ?? event.text;
  }
  if (event.cause) return causeWords(event, event.cause);
  const key = `run.event.${event.code === "answer" ? answerKey(args) : event.code}`;
  if (!i18next.exists(key)) return event.text;
  return i18next.t(key, { ...args, value: answerWords(args.value), robot: nameOf(robot), device: nameOf(device) });
}

/** Why a step was not done; with what has become of the run, where it is the run's. */
function causeWords(event: RunEvent, cause: Cause): string {
  const why = reasonWords(cause, event.text);
  const key = `reason.event.${event.code}`;
  return event.kind === "run" && i18next.exists(key) ? i18next.t(key, { why }) : why;
}

/** `answer_DONE`, and with a reason `answer_FAILED_why`. */
function answerKey(args: RunEvent["args"]): string {
  return `answer_${String(args.status)}${args.why ? "_why" : ""}`;
}

function answerWords(value: unknown): string {
  if (typeof value === "boolean") return i18next.t(value ? "run.question.yes" : "run.question.no");
  return typeof value === "string" || typeof value === "number" ? String(value) : "";
}

function scalars(args: Readonly<Record<string, unknown>>): Record<string, string | number | boolean> {
  const kept = Object.entries(args).filter(([, value]) => ["string", "number", "boolean"].includes(typeof value));
  return Object.fromEntries(kept) as Record<string, string | number | boolean>;
}
