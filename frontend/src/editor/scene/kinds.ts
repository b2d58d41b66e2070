/** One record per construct: feeds the tool rail, shortcuts, chips and the step list. */

export type Family = "motion" | "machine" | "logic" | "func";
export type Shape = "pill" | "box" | "diamond" | "header" | "fork";

export interface Kind {
  readonly kind: string;
  readonly icon: string;
  readonly family: Family;
  readonly shape: Shape;
  /** The key that takes the tool. */
  readonly key: string;
}

export const KINDS: readonly Kind[] = [
  { kind: "move", icon: "move", family: "motion", shape: "pill", key: "M" },
  { kind: "pick", icon: "pick", family: "motion", shape: "pill", key: "K" },
  { kind: "drop", icon: "drop", family: "motion", shape: "pill", key: "J" },
  { kind: "pick_and_drop", icon: "pickdrop", family: "motion", shape: "pill", key: "P" },
  { kind: "operate", icon: "operate", family: "machine", shape: "pill", key: "O" },
  { kind: "wait", icon: "wait", family: "machine", shape: "pill", key: "U" },
  { kind: "if", icon: "if", family: "logic", shape: "diamond", key: "I" },
  { kind: "while", icon: "while", family: "logic", shape: "header", key: "W" },
  { kind: "parallel", icon: "parallel", family: "logic", shape: "fork", key: "L" },
  { kind: "try", icon: "try", family: "logic", shape: "header", key: "T" },
  { kind: "call", icon: "fn", family: "func", shape: "box", key: "F" },
];

const UNKNOWN: Kind = { kind: "unknown", icon: "comment", family: "func", shape: "box", key: "" };

export function kindOf(name: string): Kind {
  return KINDS.find((kind) => kind.kind === name) ?? UNKNOWN;
}
