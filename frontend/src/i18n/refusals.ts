/** A refusal of the server in the language of the screen, where it says what it is made of. */
import i18next from "i18next";
import { faultsOf, faultsWords } from "./faults";

/** The sentence for a refusal; null where the screens do not know it, so that the server's own is shown. */
export function refusalWords(code: string, args: Readonly<Record<string, unknown>> | undefined): string | null {
  const faults = faultsOf(args);
  if (faults.length > 0) return faultsWords(faults);
  const key = `refusal.${code}.${String(args?.why)}`;
  const count = typeof args?.count === "number" ? args.count : undefined;
  if (!args || !i18next.exists(key, { count })) return plainWords(code);
  return placed(i18next.t(key, { ...args, count, first: inLanguage(args.first) }).trim(), args);
}

interface TextFault {
  readonly line: number;
  readonly why: string;
  readonly cause: { readonly code: string; readonly args: Readonly<Record<string, string>> } | null;
}

/** What is wrong with the text of a test and where, with the language that it is said in. */
export function textFaultWords({ line, why, cause }: TextFault): { text: string; lang?: string } {
  const key = `refusal.bad_test.${cause?.code ?? ""}`;
  if (!cause || !i18next.exists(key)) return { text: placed(why, { line }), lang: "en" };
  return { text: placed(i18next.t(key, { ...cause.args }), { ...cause.args, line }) };
}

/** Words about a text, with the line and the fault on purpose that they are about, where they are about one. */
function placed(words: string, { line, fault }: Readonly<Record<string, unknown>>): string {
  const inFault = typeof fault === "string" ? i18next.t("refusal.at_fault", { fault, words }) : words;
  return typeof line === "number" && line > 0 ? i18next.t("refusal.at_line", { line, words: inFault }) : inFault;
}

/** What is said of a refusal whatever it is made of. */
function plainWords(code: string): string | null {
  const key = `shell.refusal.${code}`;
  return i18next.exists(key) ? i18next.t(key) : null;
}

/** A sentence that the server gives in each language. */
function inLanguage(words: unknown): string {
  if (typeof words !== "object" || words === null) return "";
  const byLanguage = words as Readonly<Record<string, string>>;
  return byLanguage[i18next.language.slice(0, 2)] ?? byLanguage.en ?? "";
}
