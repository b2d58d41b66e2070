/** The kinds of steps: what each looks like, which branches it has, and the key that draws it. */
import type { StepKind } from "@/api/types";

export type Family = "motion" | "machine" | "logic" | "func" | "note";
export type Shape = "pill" | "box" | "diamond" | "header" | "fork" | "root" | "note";

interface Look {
  readonly icon: string;
  readonly family: Family;
  readonly shape: Shape;
  /** The key that takes the tool; empty where there is none. */
  readonly key: string;
  /** Rarely drawn: found under "more" instead of in the rail. */
  readonly rare?: boolean;
  /** In the order in which they are read; those of a Parallel are its own to name. */
  readonly branches?: readonly string[];
}

/** In the order of the rail. */
const LOOKS: Readonly<Record<StepKind, Look>> = {
  move: { icon: "move", family: "motion", shape: "pill", key: "M" },
  pick: { icon: "pick", family: "motion", shape: "pill", key: "K" },
  drop: { icon: "drop", family: "motion", shape: "pill", key: "J" },
  pick_and_drop: { icon: "pickdrop", family: "motion", shape: "pill", key: "P" },
  operate: { icon: "operate", family: "machine", shape: "pill", key: "O" },
  wait: { icon: "wait", family: "machine", shape: "pill", key: "U" },
  if: { icon: "if", family: "logic", shape: "diamond", key: "I", branches: ["then", "else"] },
  while: { icon: "while", family: "logic", shape: "header", key: "W", branches: ["body"] },
  repeat: { icon: "repeat", family: "logic", shape: "header", key: "R", branches: ["body"] },
  for_each: { icon: "foreach", family: "logic", shape: "header", key: "E", branches: ["body"] },
  parallel: { icon: "parallel", family: "logic", shape: "fork", key: "L" },
  try: { icon: "try", family: "logic", shape: "header", key: "T", branches: ["body", "catch", "finally"] },
  on_event: { icon: "event", family: "logic", shape: "root", key: "G", rare: true, branches: ["body"] },
  break: { icon: "break", family: "logic", shape: "box", key: "", rare: true },
  return: { icon: "return", family: "logic", shape: "box", key: "", rare: true },
  end: { icon: "end", family: "logic", shape: "box", key: "", rare: true },
  call: { icon: "fn", family: "func", shape: "box", key: "F" },
  set: { icon: "set", family: "func", shape: "box", key: "S" },
  notify: { icon: "notify", family: "func", shape: "box", key: "N" },
  ask: { icon: "ask", family: "func", shape: "box", key: "A", rare: true },
  comment: { icon: "comment", family: "note", shape: "note", key: "C" },
};

export interface Kind extends Look {
  readonly kind: string;
}

export const STEP_KINDS: readonly (Kind & { readonly kind: StepKind })[] = Object.entries(LOOKS).map(
  ([kind, look]) => ({ kind: kind as StepKind, ...look }),
);

const UNKNOWN: Kind = { kind: "unknown", icon: "comment", family: "func", shape: "box", key: "" };

/** Documents come from other versions, too: not every name is a kind that these screens know. */
export function isStepKind(name: string): name is StepKind {
  return Object.hasOwn(LOOKS, name);
}

export function kindOf(name: string): Kind {
  return isStepKind(name) ? { kind: name, ...LOOKS[name] } : UNKNOWN;
}

/** The word for a kind of step in the catalogues. */
export function kindWordKey(name: string): string {
  return `editor.kind.${isStepKind(name) ? name : "unknown"}`;
}

/** Kinds whose body is drawn inside a frame around their head. */
export function isFramed(name: string): boolean {
  return kindOf(name).shape === "header";
}

/** Frames that carry an arrow on their border: what stands in them is done again. */
export function isLoop(name: string): boolean {
  return name === "while" || name === "repeat" || name === "for_each";
}
