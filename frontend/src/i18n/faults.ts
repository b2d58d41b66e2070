/** What is wrong with a device's message, in the language of the screen; where it is stands before it. */
import i18next from "i18next";

/** What is wrong with something that a device sends, or was mended in it. */
export interface Fault {
  /** The English sentence. */
  readonly text: string;
  /** From 1; 0 where there is none. */
  readonly line: number;
  readonly column: number;
  /** Into JSON; may be empty. */
  readonly path: string;
  /** What the sentence is made of; empty where it stands for itself. */
  readonly code: string;
  readonly args: Readonly<Record<string, number | string>>;
}

/** The faults among the arguments of a line of history, an alert or a refusal; older ones have none. */
export function faultsOf(args: Readonly<Record<string, unknown>> | undefined): readonly Fault[] {
  return Array.isArray(args?.faults) ? (args.faults as Fault[]) : [];
}

/** Whether the screens have words of their own for it. */
export function isKnownFault({ code }: Fault): boolean {
  return code !== "" && i18next.exists(`fault.${code}`);
}

/** The sentence; the server's English where the screens do not know it. */
export function faultWords(fault: Fault): string {
  return isKnownFault(fault) ? i18next.t(`fault.${fault.code}`, { ...fault.args }) : fault.text;
}

/** `Line 2, column 5:`; empty where neither is known. */
export function faultPlace({ line, column }: Fault): string {
  if (line === 0) return "";
  return column > 0 ? i18next.t("problems.at", { line, column }) : i18next.t("problems.atLine", { line });
}

/** All sentences with their places, as one text. */
export function faultsWords(faults: readonly Fault[]): string {
  return faults
    .map((fault) => [faultPlace(fault) || fault.path, faultWords(fault)].filter(Boolean).join(" "))
    .join(" ");
}
