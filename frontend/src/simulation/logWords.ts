/** A line of a rehearsal's log in the language of the screen; one without a code is shown as it was written. */
import i18next from "i18next";
import type { LogLine } from "@/api/types";

type Line = Pick<LogLine, "device" | "text"> & Partial<LogLine>;

export function logWords(line: Line, nameOf: (device: string) => string): string {
  const { code = "", args = {}, device, text } = line;
  const key = `simulation.log.${args.why && code === "answer" ? "answer_why" : code}`;
  if (!code || !i18next.exists(key)) return text;
  return i18next.t(key, {
    ...args,
    device: nameOf(device),
    value: valueWords(args.value),
    status: i18next.t(`simulation.log.status.${String(args.status)}`, { defaultValue: String(args.status ?? "") }),
  });
}

function valueWords(value: unknown): string {
  if (typeof value === "boolean") return i18next.t(value ? "run.question.yes" : "run.question.no");
  return (
    (typeof value === "string" || typeof value === "number" ? String(value) : "") || i18next.t("simulation.log.nothing")
  );
}
