/** What stands on a step's chip: a noun and an amount, a "?" where a value is still to be entered. */
import { ownEntry } from "@/design/ownEntry";
import { type Place, type Step, type Value, textOf } from "../document/document";
import { type FieldRecord, isStepKind, kindOf } from "../kinds";
import { isRobot } from "@/map/devices/device";
import { DEFAULT_ROLE, methodOf, operatedRole } from "../operation";
import { endingText } from "./parallelWords";
import { durationText, placeName, roleName, type Speaker, valueText, withUnit } from "./valueWords";

export { durationText, placeName, roleName, valueText, withUnit } from "./valueWords";
export type { Speaker, Translate } from "./valueWords";

export interface TextPart {
  readonly text: string;
  /** A word that belongs to the kind and to no value of the step is a "word"; what stood there before is "old". */
  readonly tone: "plain" | "word" | "missing" | "soft" | "mono" | "old";
  /** A colour to show before the text that names it. */
  readonly swatch?: string;
}

const MISSING: TextPart = { text: "?", tone: "missing" };
/** Longer sentences are cut on the chip; the inspector and the list have the whole. */
const LONGEST = 26;

type Writer = (step: Step, speaker: Speaker) => readonly TextPart[];

/** Chips that say more than their fields; those of all other kinds follow from a template of the catalogue. */
const WRITERS: Readonly<Partial<Record<string, Writer>>> = {
  operate: operateText,
  call: callText,
  for_each: forEachText,
  parallel: parallelText,
  comment: commentText,
};

export function chipText(step: Step, speaker: Speaker): readonly TextPart[] {
  if (!isStepKind(step.kind)) return [plain(speaker.t("kind.unknown"))];
  return (WRITERS[step.kind] ?? templateText)(step, speaker);
}

/** The condition of an If or a While for the tag beside it. */
export function conditionText(step: Step, speaker: Speaker): readonly TextPart[] {
  const text = valueText(step.params.condition as Value, speaker);
  return text === null ? [MISSING] : [{ text, tone: "mono" }];
}

function plain(text: string): TextPart {
  return { text, tone: "plain" };
}

/** A template such as "repeat|{{times}}|×": each part with what stands in its field, or with the mark that it misses. */
function templateText(step: Step, speaker: Speaker): readonly TextPart[] {
  const { kind, forms } = kindOf(step.kind);
  const marked = forms.find((form) => form.marked_by && (step.params[form.marked_by] ?? null) !== null);
  const form = marked ?? forms.at(-1);
  const fields = new Map((form?.fields ?? []).map((field) => [field.name, field]));
  const said = new Map([...fields.values()].map((field) => [field.name, fieldPart(field, step, speaker)]));
  const holes = Object.fromEntries([...fields.keys()].map((name) => [name, `⟦${name}⟧`]));
  const key = `chip.${marked ? `${kind}_${marked.marked_by}` : kind}`;
  const words = speaker.t(key, holes);
  const missing = [...said].some(([name, part]) => part === null && words.includes(holes[name] ?? ""));
  const template = missing ? speaker.t(`${key}_missing`, { ...holes, defaultValue: words }) : words;
  return template.split("|").flatMap((segment) => segmentParts(segment, fields, said));
}

/** One part of a chip; where a value in it is missing, its words stand before and behind the mark. */
function segmentParts(
  segment: string,
  fields: ReadonlyMap<string, FieldRecord>,
  said: ReadonlyMap<string, TextPart | null>,
): readonly TextPart[] {
  const names = [...segment.matchAll(/⟦(\w+)⟧/g)].map(([, name]) => name ?? "");
  const [only] = names;
  if (only === undefined) return [{ text: segment, tone: "word" }];
  if (segment === `⟦${only}⟧`)
    return [said.get(only) ?? (fields.get(only)?.optional ? null : MISSING)].filter((part) => part !== null);
  const filled = segment.replace(/⟦(\w+)⟧/g, (_, name: string) => said.get(name)?.text ?? "\0");
  const [first = "", ...rest] = filled.split("\0").map((text) => text.trim());
  const parts = [plain(first), ...rest.flatMap((text) => [MISSING, plain(text)])];
  return parts.filter((part) => part.text !== "");
}

/** What stands in a field; null where that is still to be entered. */
function fieldPart(field: FieldRecord, step: Step, speaker: Speaker): TextPart | null {
  const value = (step.params[field.name] ?? null) as Value;
  if (field.type === "role") return plain(roleName(textOf(value, DEFAULT_ROLE), speaker));
  if (field.type === "place") return partOf(placeName(value as Place | null, speaker));
  if (field.type === "variable") return partOf(textOf(value) || null);
  if (field.type === "zone") return partOf(zoneName(textOf(value), speaker));
  if (field.type !== "value") return null;
  if (field.wanted === "time" && typeof value === "number") return plain(durationText(value));
  const { family, shape } = kindOf(step.kind);
  const full = family === "func" || shape === "root";
  // A condition that leaves out whose reading it looks at could be about any machine.
  const named = full || field.wanted === "boolean";
  const text = valueText(value, named ? { ...speaker, full: true } : speaker);
  if (text === null) return null;
  if (field.wanted === "text") return { text: shortened(text), tone: "soft" };
  if (field.wanted) return plain(text);
  return full ? { ...plain(shortened(text)), ...swatchOf(value) } : plain(shortened(text));
}

function zoneName(id: string, { document }: Speaker): string | null {
  return id ? textOf(ownEntry(document.zones, id)?.name) || id : null;
}

function partOf(text: string | null): TextPart | null {
  return text === null ? null : plain(text);
}

function operateText(step: Step, speaker: Speaker): TextPart[] {
  const { device, method } = methodOf(step, speaker.surroundings, speaker.document);
  const robot = robotName(step, speaker);
  const first = robot === null ? [] : [plain(robot), plain("·")];
  if (!step.params.method) return [...first, MISSING];
  const parts = [...first, plain(method?.title || textOf(step.params.method))];
  const args = (step.params.args ?? {}) as Record<string, Value>;
  for (const parameter of method?.parameters ?? []) {
    const value = ownEntry(args, parameter.name);
    const text = valueText(value ?? null, speaker);
    const fixed = typeof value !== "object";
    if (text !== null) parts.push(plain(`· ${fixed ? withUnit(text, parameter.unit) : text}`));
    else if (parameter.required !== false) parts.push(MISSING);
  }
  return device || robot !== null ? parts : [MISSING, ...parts];
}

/** What an Operate calls its robot, for a robot does not stand where the step does; null where it has none. */
function robotName(step: Step, speaker: Speaker): string | null {
  const role = operatedRole(step.params.device);
  if (role !== null) return roleName(role, speaker);
  const { device } = methodOf(step, speaker.surroundings, speaker.document);
  return device && isRobot(device) ? device.name : null;
}

function forEachText(step: Step, speaker: Speaker): TextPart[] {
  const items = Array.isArray(step.params.items) ? (step.params.items as Value[]) : [];
  const [first, second, ...rest] = items.map((each) => valueText(each, speaker) ?? "?");
  const names = [first, second].filter((name) => name !== undefined).join(", ");
  const variable = textOf(step.params.variable) || "?";
  const index = textOf(step.params.index);
  const listed = valueText((step.params.list ?? null) as Value, speaker);
  const whole = items.length === 0 ? MISSING : plain(rest.length > 0 ? `${names} +${rest.length}` : names);
  return [
    plain(speaker.t(index ? "chip.for_each_counted" : "chip.for_each", { variable, index })),
    (step.params.list ?? null) === null ? whole : listed === null || listed === "?" ? MISSING : plain(listed),
  ];
}

function parallelText(step: Step, { t }: Speaker): TextPart[] {
  const ends = endingText(step, t);
  const word: TextPart = { text: t("chip.parallel"), tone: "word" };
  return ends === null ? [word] : [word, { text: ends, tone: "soft" }];
}

function commentText(step: Step, { t }: Speaker): TextPart[] {
  const text = typeof step.params.text === "string" ? step.params.text.trim() : "";
  return [text ? plain(shortened(text, 44)) : { text: t("chip.comment"), tone: "soft" }];
}

function shortened(text: string, longest = LONGEST): string {
  return text.length > longest ? `${text.slice(0, longest - 1).trimEnd()}…` : text;
}

function callText(step: Step, speaker: Speaker): TextPart[] {
  const definition = ownEntry(speaker.document.functions, String(step.params.function));
  if (!definition) return [MISSING];
  const result = step.params.result ? [plain(`${textOf(step.params.result)} =`)] : [];
  const args = (step.params.args ?? {}) as Record<string, Value | Place>;
  const given = definition.parameters.map((parameter) => {
    const value = ownEntry(args, parameter.name) ?? (parameter.default as Value | Place | undefined) ?? null;
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
