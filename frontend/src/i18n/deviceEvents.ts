/** A line of a device's history in the language of the screen; older lines are shown as they were written. */
import i18next from "i18next";
import type { DeviceEvent } from "@/api/devices";
import { formatPoint } from "./format";

type Args = Readonly<Record<string, unknown>>;

export function deviceEventWords(event: DeviceEvent): string {
  const parts = event.args.parts;
  if (event.code === "described" && Array.isArray(parts)) return describedWords(parts as Args[]) || event.text;
  return wordsOf(`device.event.${event.code}`, event.args) ?? event.text;
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
