/** What is told of functions of the library, in words: what a newer version changes, what devices lack. Pure. */
import type { TFunction } from "i18next";
import type { FunctionReason, NeedOfDevice } from "@/api/types";
import { unitSign } from "@/i18n/units";

const ABILITIES = ["methods", "gives", "takes", "readings"] as const;
const TOLD_BY_WHOM: readonly string[] = ["needs_new", "needs_more"];

/** All that somebody must be able to do: “lift, take box”. */
export function abilityWords(t: TFunction, need: NeedOfDevice): string {
  return ABILITIES.flatMap((kind) => need[kind].map((name) => t(`library.ability.${kind}`, { name }))).join(", ");
}

/** A need as part of a sentence: “a robot that can lift”. */
export function needWords(t: TFunction, need: NeedOfDevice): string {
  const list = abilityWords(t, need);
  return t(`library.need.${list ? need.of : `${need.of}_any`}`, { name: need.name, list });
}

/** “Lacks a robot that can lift and 2 more”; empty where nothing is lacking or nobody has looked. */
export function lackWords(t: TFunction, lacks: readonly NeedOfDevice[] | null): string {
  const [first, ...more] = lacks ?? [];
  if (!first) return "";
  const what = needWords(t, first);
  return more.length > 0 ? t("library.lacksMore", { what, count: more.length }) : t("library.lacks", { what });
}

/** What is otherwise in a newer version, as a sentence. */
export function reasonWords(t: TFunction, reason: FunctionReason): string {
  const { code, name, of } = reason;
  const key = TOLD_BY_WHOM.includes(code) ? `${code}_${of}` : code;
  const say = (text: string) => saidOf(t, code, text);
  return t(`library.reason.${key}`, { name, old: say(reason.old), new: say(reason.new) });
}

function saidOf(t: TFunction, code: FunctionReason["code"], text: string): string {
  if (code.endsWith("_unit")) return text ? unitSign(text) : t("library.noUnit");
  if (code.endsWith("_type") || code === "parameter_wanted" || code === "result_added" || code === "parameter_gone")
    return text ? t(`library.type.${text}`, { defaultValue: text }) : "";
  return code.startsWith("default") || code === "parameter_added" ? valueWords(text) : text;
}

/** A default as people write it; it comes as JSON. */
export function valueWords(json: string): string {
  try {
    return plainWords(JSON.parse(json));
  } catch {
    return json;
  }
}

function plainWords(value: unknown): string {
  if (typeof value === "string" || typeof value === "number" || typeof value === "boolean") return String(value);
  const quantity = (value as { quantity?: unknown } | null)?.quantity;
  if (Array.isArray(quantity)) return `${String(quantity[0])} ${unitSign(String(quantity[1]))}`;
  const named = value as { device?: unknown; place?: unknown } | null;
  if (typeof named?.device === "string") return named.device;
  if (typeof named?.place === "string") return named.place;
  return JSON.stringify(value);
}

export function isBreaking(reasons: readonly FunctionReason[] | null): boolean {
  return (reasons ?? []).some((reason) => reason.breaks);
}
