/** One record per construct: feeds the tool rail, shortcuts, chips and the step list. */

export type Family = "motion" | "machine" | "logic" | "func" | "note";
export type Shape = "pill" | "box" | "diamond" | "header" | "fork" | "root" | "note";

export interface Kind {
  readonly kind: string;
  readonly icon: string;
  readonly family: Family;
  readonly shape: Shape;
  /** The key that takes the tool; empty where there is none. */
  readonly key: string;
  /** Rarely drawn: found under "more" instead of in the rail. */
  readonly rare?: boolean;
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
  { kind: "repeat", icon: "repeat", family: "logic", shape: "header", key: "R" },
  { kind: "for_each", icon: "foreach", family: "logic", shape: "header", key: "E" },
  { kind: "parallel", icon: "parallel", family: "logic", shape: "fork", key: "L" },
  { kind: "try", icon: "try", family: "logic", shape: "header", key: "T" },
  { kind: "on_event", icon: "event", family: "logic", shape: "root", key: "G", rare: true },
  { kind: "break", icon: "break", family: "logic", shape: "box", key: "", rare: true },
  { kind: "return", icon: "return", family: "logic", shape: "box", key: "", rare: true },
  { kind: "end", icon: "end", family: "logic", shape: "box", key: "", rare: true },
  { kind: "call", icon: "fn", family: "func", shape: "box", key: "F" },
  { kind: "set", icon: "set", family: "func", shape: "box", key: "S" },
  { kind: "notify", icon: "notify", family: "func", shape: "box", key: "N" },
  { kind: "ask", icon: "ask", family: "func", shape: "box", key: "A", rare: true },
  { kind: "comment", icon: "comment", family: "note", shape: "note", key: "C" },
  { kind: "zone", icon: "zone", family: "note", shape: "note", key: "Z" },
];

const UNKNOWN: Kind = { kind: "unknown", icon: "comment", family: "func", shape: "box", key: "" };

export function kindOf(name: string): Kind {
  return KINDS.find((kind) => kind.kind === name) ?? UNKNOWN;
}

/** Kinds whose body is drawn inside a frame around their head. */
export function isFramed(name: string): boolean {
  return kindOf(name).shape === "header";
}

/** Frames that carry an arrow on their border: what stands in them is done again. */
export function isLoop(name: string): boolean {
  return name === "while" || name === "repeat" || name === "for_each";
}
