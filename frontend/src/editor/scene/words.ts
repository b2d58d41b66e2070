/** What stands on a step's chip: a noun and an amount, a "?" where a value is still to be entered. */
import type { Place, ProgramDocument, Step, Value } from "../model/types";
import type { Surroundings } from "./surroundings";

export interface TextPart {
  readonly text: string;
  readonly tone: "plain" | "missing" | "soft" | "mono";
}

/** A translator: catalogue key and values to text. */
export type Translate = (key: string, values?: Record<string, unknown>) => string;

export interface Speaker {
  readonly t: Translate;
  readonly surroundings: Surroundings;
  readonly document: ProgramDocument;
}

const MISSING: TextPart = { text: "?", tone: "missing" };

export function chipText(step: Step, speaker: Speaker): readonly TextPart[] {
  const { t } = speaker;
  switch (step.kind) {
    case "move":
      return moveText(step, speaker);
    case "pick":
    case "drop":
    case "pick_and_drop":
      return loadText(step, speaker);
    case "operate":
      return operateText(step, speaker);
    case "wait":
      return waitText(step, speaker);
    case "call":
      return callText(step, speaker);
    case "if":
      return [plain(t("chip.if"))];
    case "while":
    case "parallel":
    case "try":
      return [plain(t(`kind.${step.kind}`))];
    default:
      return [plain(t("kind.unknown"))];
  }
}

/** The condition of an If or a While for the tag beside it. */
export function conditionText(step: Step, speaker: Speaker): readonly TextPart[] {
  const text = valueText(step.params.condition as Value, speaker);
  return text === null ? [MISSING] : [{ text, tone: "mono" }];
}

function plain(text: string): TextPart {
  return { text, tone: "plain" };
}

function moveText(step: Step, speaker: Speaker): TextPart[] {
  const name = placeName(step.params.to as Place, speaker);
  if (name === null) return [plain(speaker.t("chip.move")), MISSING];
  return [plain(speaker.t("chip.move_to", { place: name }))];
}

function loadText(step: Step, speaker: Speaker): TextPart[] {
  const quantity = valueText((step.params.quantity ?? null) as Value, speaker);
  const object = valueText((step.params.object ?? null) as Value, speaker);
  return [quantity === null ? MISSING : plain(quantity), plain("×"), object === null ? MISSING : plain(object)];
}

function operateText(step: Step, speaker: Speaker): TextPart[] {
  const { device, method } = methodOf(step, speaker.surroundings);
  if (!step.params.method) return [MISSING];
  const parts = [plain(method?.title ?? String(step.params.method))];
  const args = (step.params.args ?? {}) as Record<string, Value>;
  for (const parameter of method?.parameters ?? []) {
    const text = valueText(args[parameter.name] ?? null, speaker);
    const fixed = typeof args[parameter.name] !== "object";
    if (text !== null) parts.push(plain(`· ${fixed ? withUnit(text, parameter.unit) : text}`));
    else if (parameter.required !== false) parts.push(MISSING);
  }
  return device ? parts : [MISSING, ...parts];
}

export function methodOf(step: Step, surroundings: Surroundings) {
  const place = step.params.device as { device?: string } | undefined;
  const device = place?.device ? surroundings.devices.get(place.device) : undefined;
  const method = device?.methods.find((each) => each.name === step.params.method);
  return { device, method };
}

function waitText(step: Step, speaker: Speaker): TextPart[] {
  const { t } = speaker;
  if (step.params.until !== undefined && step.params.until !== null)
    return [plain(valueText(step.params.until as Value, speaker) ?? "?")];
  const seconds = step.params.duration as Value;
  if (typeof seconds === "number") return [plain(t("chip.wait", { time: durationText(seconds) }))];
  const text = valueText(seconds ?? null, speaker);
  return text === null ? [plain(t("chip.wait_word")), MISSING] : [plain(t("chip.wait", { time: text }))];
}

function callText(step: Step, speaker: Speaker): TextPart[] {
  const definition = speaker.document.functions[String(step.params.function)];
  if (!definition) return [MISSING];
  const args = (step.params.args ?? {}) as Record<string, Value | Place>;
  const inner = definition.parameters.map((parameter) => {
    const given = args[parameter.name] ?? (parameter.default as Value | Place | undefined) ?? null;
    const text = placeName(given as Place, speaker) ?? valueText(given as Value, speaker);
    return `${parameter.name}: ${text ?? "?"}`;
  });
  return [plain(definition.name), { text: `(${inner.join(", ")})`, tone: "soft" }];
}

/** A place's name; null where it is not entered. */
export function placeName(place: Place | null | undefined, speaker: Speaker): string | null {
  if (typeof place !== "object" || place === null) return null;
  if ("device" in place) return speaker.surroundings.devices.get(place.device)?.name ?? place.device;
  if ("place" in place) return speaker.surroundings.places.get(place.place)?.name ?? place.place;
  if ("point" in place) return `${place.point[0]}, ${place.point[1]}\u202fm`.replaceAll("-", "−");
  return null;
}

const SIGNS: Readonly<Record<string, string>> = { "==": "=", "!=": "≠", "<=": "≤", ">=": "≥" };

/** A value as people read it; null where it is not entered. */
export function valueText(value: Value | undefined, speaker: Speaker): string | null {
  if (value === null || value === undefined || value === "") return null;
  if (typeof value === "number") return String(value).replace("-", "−");
  if (typeof value === "boolean") return speaker.t(value ? "value.true" : "value.false");
  if (typeof value === "string") return value;
  if ("param" in value) return value.param;
  if ("property" in value) return value.property[1];
  if (!("op" in value)) return null;
  const args = value.args.map((each) => valueText(each, speaker) ?? "?");
  if (value.op === "not") return `${speaker.t("value.not")} ${args[0] ?? "?"}`;
  const sign = value.op === "and" || value.op === "or" ? speaker.t(`value.${value.op}`) : (SIGNS[value.op] ?? value.op);
  return args.join(` ${sign} `);
}

const UNITS: Readonly<Record<string, string>> = {
  MIN: "min",
  SEC: "s",
  HR: "h",
  DEG_C: "°C",
  CEL: "°C",
  PERCENT: "%",
  M: "m",
};

export function unitText(unit: string | null | undefined): string {
  if (!unit) return "";
  return UNITS[unit] ?? UNITS[unit.toUpperCase()] ?? unit;
}

export function withUnit(text: string, unit: string | null | undefined): string {
  const sign = unitText(unit);
  return sign ? `${text}\u202f${sign}` : text;
}

/** Seconds as "1 min 6 s". */
export function durationText(seconds: number): string {
  const whole = Math.round(seconds * 10) / 10;
  if (whole < 60) return `${whole}\u202fs`;
  const minutes = Math.floor(whole / 60);
  const rest = Math.round(whole - minutes * 60);
  return rest ? `${minutes}\u202fmin ${rest}\u202fs` : `${minutes}\u202fmin`;
}

export function plainText(parts: readonly TextPart[]): string {
  return parts.map((part) => part.text).join(" ");
}
