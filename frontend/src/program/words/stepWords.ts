/** What stands on a step's chip: a noun and an amount, a "?" where a value is still to be entered. */
import { type Place, type Step, type StepKind, type Value, textOf } from "../document/document";
import { isStepKind } from "../kinds";
import type { Surroundings } from "../surroundings";
import { durationText, placeName, type Speaker, valueText, withUnit } from "./valueWords";

export { durationText, placeName, UNIT_CHOICES, unitText, valueText, withUnit } from "./valueWords";
export type { Speaker, Translate } from "./valueWords";

export interface TextPart {
  readonly text: string;
  readonly tone: "plain" | "missing" | "soft" | "mono";
  /** A colour to show before the text that names it. */
  readonly swatch?: string;
}

const MISSING: TextPart = { text: "?", tone: "missing" };
/** Longer sentences are cut on the chip; the inspector and the list have the whole. */
const LONGEST = 26;

type Writer = (step: Step, speaker: Speaker) => readonly TextPart[];

const WRITERS: Readonly<Record<StepKind, Writer>> = {
  move: moveText,
  pick: loadText,
  drop: loadText,
  pick_and_drop: loadText,
  operate: operateText,
  wait: waitText,
  call: callText,
  if: (_step, { t }) => [plain(t("chip.if"))],
  while: named,
  parallel: named,
  try: named,
  break: named,
  end: named,
  repeat: repeatText,
  for_each: forEachText,
  set: setText,
  ask: (step, speaker) => sentenceText("ask", step.params.question, speaker),
  notify: (step, speaker) => sentenceText("notify", step.params.message, speaker),
  return: returnText,
  on_event: eventText,
  comment: commentText,
};

export function chipText(step: Step, speaker: Speaker): readonly TextPart[] {
  return isStepKind(step.kind) ? WRITERS[step.kind](step, speaker) : [plain(speaker.t("kind.unknown"))];
}

/** The condition of an If or a While for the tag beside it. */
export function conditionText(step: Step, speaker: Speaker): readonly TextPart[] {
  const text = valueText(step.params.condition as Value, speaker);
  return text === null ? [MISSING] : [{ text, tone: "mono" }];
}

function plain(text: string): TextPart {
  return { text, tone: "plain" };
}

function named(step: Step, { t }: Speaker): TextPart[] {
  return [plain(t(`kind.${step.kind}`))];
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
  const parts = [plain(method?.title ?? textOf(step.params.method))];
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
  const duration = step.params.duration as Value;
  if (typeof duration === "number") return [plain(t("chip.wait", { time: durationText(duration) }))];
  const text = valueText(duration ?? null, speaker);
  return text === null ? [plain(t("chip.wait_word")), MISSING] : [plain(t("chip.wait", { time: text }))];
}

function repeatText(step: Step, speaker: Speaker): TextPart[] {
  const times = valueText(step.params.times as Value, speaker);
  return [plain(speaker.t("chip.repeat")), times === null ? MISSING : plain(times), plain("×")];
}

function forEachText(step: Step, speaker: Speaker): TextPart[] {
  const items = Array.isArray(step.params.items) ? (step.params.items as Value[]) : [];
  const [first, second, ...rest] = items.map((each) => valueText(each, speaker) ?? "?");
  const names = [first, second].filter((name) => name !== undefined).join(", ");
  const variable = textOf(step.params.variable) || "?";
  return [
    plain(speaker.t("chip.for_each", { variable })),
    items.length === 0 ? MISSING : plain(rest.length > 0 ? `${names} +${rest.length}` : names),
  ];
}

function setText(step: Step, speaker: Speaker): TextPart[] {
  const name = step.params.variable ? plain(textOf(step.params.variable)) : MISSING;
  return [name, plain("="), valuePart(step.params.value as Value, speaker)];
}

function valuePart(value: Value, speaker: Speaker): TextPart {
  const text = valueText(value, { ...speaker, full: true });
  return text === null ? MISSING : { ...plain(shortened(text)), ...swatchOf(value) };
}

function sentenceText(word: "ask" | "notify", value: unknown, speaker: Speaker): TextPart[] {
  const text = valueText(value as Value, { ...speaker, full: true });
  return [plain(speaker.t(`chip.${word}`)), text === null ? MISSING : { text: shortened(text), tone: "soft" }];
}

function returnText(step: Step, speaker: Speaker): TextPart[] {
  const text = valueText(step.params.value as Value, speaker);
  return [plain(speaker.t("chip.return")), ...(text === null ? [] : [plain(shortened(text))])];
}

function eventText(step: Step, speaker: Speaker): TextPart[] {
  const text = valueText(step.params.condition as Value, { ...speaker, full: true });
  return [plain(speaker.t("chip.when")), text === null ? MISSING : plain(text)];
}

function commentText(step: Step, { t }: Speaker): TextPart[] {
  const text = typeof step.params.text === "string" ? step.params.text.trim() : "";
  return [text ? plain(shortened(text, 44)) : { text: t("chip.comment"), tone: "soft" }];
}

function shortened(text: string, longest = LONGEST): string {
  return text.length > longest ? `${text.slice(0, longest - 1).trimEnd()}…` : text;
}

function callText(step: Step, speaker: Speaker): TextPart[] {
  const definition = speaker.document.functions[String(step.params.function)];
  if (!definition) return [MISSING];
  const result = step.params.result ? [plain(`${textOf(step.params.result)} =`)] : [];
  const args = (step.params.args ?? {}) as Record<string, Value | Place>;
  const given = definition.parameters.map((parameter) => {
    const value = args[parameter.name] ?? (parameter.default as Value | Place | undefined) ?? null;
    const text = placeName(value as Place, speaker) ?? valueText(value as Value, speaker);
    return { name: parameter.name, text: text ?? "?", ...swatchOf(value as Value) };
  });
  return [...result, plain(definition.name), ...argumentParts(given)];
}

/** "(shade:", the colour with its name, "minutes: 3)": a part of its own for each swatch. */
function argumentParts(given: readonly { name: string; text: string; swatch?: string }[]): TextPart[] {
  const parts: TextPart[] = [];
  let text = "(";
  given.forEach(({ name, text: value, swatch }, index) => {
    const after = index < given.length - 1 ? "," : ")";
    if (swatch) {
      parts.push({ text: `${text}${name}:`, tone: "soft" }, { text: `${value}${after}`, tone: "soft", swatch });
      text = "";
    } else text += `${name}: ${value}${after}${after === "," ? " " : ""}`;
  });
  const rest = given.length === 0 ? "()" : text.trim();
  return rest ? [...parts, { text: rest, tone: "soft" }] : parts;
}

export function plainText(parts: readonly TextPart[]): string {
  return parts.map((part) => part.text).join(" ");
}

const COLOURS = new Set(
  (
    "red green blue teal yellow orange white black gray grey purple pink brown cyan magenta lime navy olive maroon " +
    "silver gold beige turquoise violet indigo crimson salmon coral khaki ivory"
  ).split(" "),
);

/** The colour as a style takes it, if the value is one. */
export function swatchOf(value: Value | undefined): { readonly swatch?: string } {
  if (typeof value !== "string") return {};
  const colour = value.trim().toLowerCase();
  return COLOURS.has(colour) || /^#[0-9a-f]{6}$/.test(colour) ? { swatch: colour } : {};
}
