/** A step's chip: what it says, how large it is, what state it is in. */
import type { Box } from "@/map/plane/projection";
import type { PixelPoint } from "@/map/plane/paths";
import type { Compiled, Diagnostic, Step } from "../document/document";
import { boxAt } from "./geometry";
import { kindOf, type Family, type Shape } from "../kinds";
import { functionOf } from "./stepPaths";
import { wordsOf } from "../words/knownWords";
import { plainText, type Speaker, type TextPart } from "../words/stepWords";

export type Measure = (text: string, font: "chip" | "badge" | "mono") => number;

export type TagSide = "right" | "above" | "below" | "below-left" | "left";

export interface Chip {
  readonly id: string;
  readonly kind: string;
  readonly icon: string;
  readonly family: Family;
  readonly shape: Shape;
  readonly number: string;
  readonly at: PixelPoint;
  readonly width: number;
  readonly height: number;
  readonly box: Box;
  readonly parts: readonly TextPart[];
  readonly condition: readonly TextPart[] | null;
  /** Where the condition of an If stands beside its diamond, and how wide it is there. */
  readonly tagSide: TagSide;
  readonly tagWidth: number;
  /** Inside a function's body: drawn smaller. */
  readonly inner: boolean;
  readonly draft: boolean;
  /** The step whose branch it stands in, for those who hear the drawing. */
  readonly inside: { readonly kind: string; readonly number: string } | null;
  readonly problem: "error" | "warning" | null;
  readonly errors: number;
  readonly movesAdded: boolean;
}

interface ChipInput {
  readonly compiled: Pick<Compiled, "numbers" | "diagnostics" | "added_moves"> | null;
  readonly measure: Measure;
  /** Steps that are joined to nothing. */
  readonly drafts: ReadonlySet<string>;
  readonly findings: ReadonlyMap<string, readonly Diagnostic[]>;
}

/** What was found of each step. */
export function findingsByStep(compiled: Pick<Compiled, "diagnostics"> | null): Map<string, Diagnostic[]> {
  const byStep = new Map<string, Diagnostic[]>();
  for (const each of compiled?.diagnostics ?? []) {
    const found = byStep.get(each.step) ?? [];
    found.push(each);
    byStep.set(each.step, found);
  }
  return byStep;
}

export function buildChip(id: string, step: Step, at: PixelPoint, input: ChipInput, speaker: Speaker): Chip {
  const { icon, family, shape } = kindOf(step.kind);
  const { compiled } = input;
  const number = compiled?.numbers[id] ?? "";
  const found = input.findings.get(id) ?? [];
  const { parts, condition } = wordsOf(step, speaker);
  const inner = functionOf(speaker.document, id) !== null;
  const size = chipSize({ shape, number, parts, condition, inner }, input.measure);
  return {
    id,
    kind: step.kind,
    icon,
    family,
    shape,
    number,
    at,
    ...size,
    box: boxAt(at, size.width, size.height),
    parts,
    condition,
    tagSide: "right",
    tagWidth: condition ? input.measure(plainText(condition), "mono") + 16 : 0,
    inner,
    draft: input.drafts.has(id),
    inside: insideOf(step, compiled, speaker),
    problem: worst(found),
    errors: found.filter((each) => each.severity === "error").length,
    movesAdded: compiled?.added_moves.includes(id) ?? false,
  };
}

function insideOf(step: Step, compiled: ChipInput["compiled"], { document }: Speaker): Chip["inside"] {
  const parent = step.place ? document.steps[step.place[0]] : undefined;
  return step.place && parent ? { kind: parent.kind, number: compiled?.numbers[step.place[0]] ?? "" } : null;
}

function worst(diagnostics: readonly Pick<Diagnostic, "severity">[]): Chip["problem"] {
  if (diagnostics.some((each) => each.severity === "error")) return "error";
  return diagnostics.length > 0 ? "warning" : null;
}

function chipSize(
  chip: Pick<Chip, "shape" | "number" | "parts" | "condition" | "inner">,
  measure: Measure,
): { width: number; height: number } {
  if (chip.shape === "diamond") return { width: 46, height: 46 };
  const badge = chip.number ? Math.max(22, measure(chip.number, "badge") + 13) + 6 : 0;
  const text = chip.parts.reduce((sum, part) => sum + partWidth(part, measure) + 4, -4);
  const width = Math.ceil(5 + badge + 16 + 7 + text + 13);
  if (chip.shape !== "header") return { width, height: chip.inner ? 24 : 28 };
  const tag = chip.condition ? measure(plainText(chip.condition), "mono") + 16 : 0;
  return { width: Math.ceil(Math.max(width, tag)), height: chip.condition ? 54 : 28 };
}

function partWidth(part: TextPart, measure: Measure): number {
  if (part.tone === "missing") return 17;
  return measure(part.text, part.tone === "mono" ? "mono" : "chip") + (part.swatch ? 14 : 0);
}
