/** A line of a device's history in the language of the screen; older lines are shown as they were written. */
import i18next from "i18next";
import { faultsOf, faultsWords } from "./faults";
import { formatPoint } from "./format";

type Args = Readonly<Record<string, unknown>>;

/** What a line of a device's history is said from; `code` is empty for older lines. */
interface DeviceEvent {
  readonly code: string;
  readonly args: Args;
  readonly text: string;
}

export function deviceEventWords(event: DeviceEvent): string {
  const parts = event.args.parts;
  if (event.code === "described" && Array.isArray(parts)) return describedWords(parts as Args[]) || event.text;
  const text = refusedWords(event.args);
  if (text === null) return wordsOf(`device.event.${event.code}`, event.args) ?? event.text;
  const words = wordsOf(`device.event.refused.${String(event.args.kind)}`, { text });
  return words ?? wordsOf(`device.event.${event.code}`, { text }) ?? event.text;
}

/** What was refused or mended, and how often it was since the last line; null where the line does not say. */
function refusedWords(args: Args): string | null {
  const faults = faultsOf(args);
  if (faults.length === 0) return null;
  const others = Number(args.more ?? 0);
  return [faultsWords(faults), others > 0 ? i18next.t("device.event.others", { count: others }) : ""].join(" ").trim();
}

/** What is different in a description: its parts in one sentence. */
function describedWords(parts: readonly Args[]): string {
  const words = parts.map((part) => wordsOf(`device.eventPart.${String(part.code)}`, part) ?? "");
  const told = words.filter(Boolean).join("; ");
  return told.slice(0, 1).toLocaleUpperCase(i18next.language) + told.slice(1);
}

function wordsOf(key: string, args: Args): string | null {
  if (key.endsWith(".") || !i18next.exists(key)) return null;
  const { x, y } = args;
  const place = typeof x === "number" && typeof y === "number" ? formatPoint(x, y) : "";
  return i18next.t(key, { ...args, place });
}
