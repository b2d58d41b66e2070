/** What is wrong with a device's message, in the language of the screen; where it is stands before it. */
import i18next from "i18next";
import type { Fault } from "@/api/faults";

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
  return column > 0 ? i18next.t("adding.at", { line, column }) : i18next.t("adding.atLine", { line });
}

/** All sentences with their places, as one text. */
export function faultsWords(faults: readonly Fault[]): string {
  return faults
    .map((fault) => [faultPlace(fault) || fault.path, faultWords(fault)].filter(Boolean).join(" "))
    .join(" ");
}
