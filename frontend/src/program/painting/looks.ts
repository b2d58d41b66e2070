/** What a picture of a program is painted by, beside its pieces. */
import type { Palette } from "@/map/plane/palette";
import type { BranchRef } from "../document/tree";
import type { Chip } from "../scene/chips";
import type { LevelOfDetail } from "../scene/detail";
import type { SharedRoute } from "../scene/pieces";

/** What happened to a step between two documents that are compared. */
export type ComparedState = "added" | "removed" | "changed" | "moved" | "same";
export type StepState = "planned" | "running" | "done" | "failed" | "skipped" | ComparedState | null;

/** Somebody else who has the step selected. */
export interface OtherPerson {
  readonly name: string;
  readonly initials: string;
  readonly colour: string;
}

export interface PaintedLooks {
  readonly selected: ReadonlySet<string>;
  readonly stateOf: (step: string) => StepState;
  readonly othersOn: ReadonlyMap<string, OtherPerson>;
  readonly chosenLink?: string | null;
  /** What an empty frame says to whoever may draw into it. */
  readonly targetWords?: (into: BranchRef) => string;
}

export interface Brush {
  readonly canvas: CanvasRenderingContext2D;
  readonly palette: Palette;
  readonly detail: LevelOfDetail;
  readonly zoom: number;
  readonly looks: PaintedLooks;
}

/** A chip with its state in colours. */
export interface Painted {
  readonly chip: Chip;
  readonly state: StepState;
  /** The colour of its family or state: badge, icon, word. */
  readonly line: string;
  readonly border: string;
  readonly soft: string;
  readonly body: string;
  readonly badge: string;
  readonly badgeText: string;
}

/** A colour as it is written in a style: `var(--busy)` by the palette. */
export function resolved(palette: Palette, colour: string): string {
  const name = /^var\(--([\w-]+)\)$/.exec(colour)?.[1];
  return (name && (palette as Readonly<Record<string, string>>)[name]) || colour;
}

/** The one of the steps that share a line that has come furthest. */
export function furthest(route: SharedRoute, stateOf: (step: string) => StepState) {
  const rank = (step: string) => ["running", "failed", "done"].indexOf(stateOf(step) ?? "");
  const ranked = route.steps
    .filter(({ step }) => rank(step) >= 0)
    .sort((one, other) => rank(one.step) - rank(other.step));
  return ranked[0] ?? route.steps[0];
}
