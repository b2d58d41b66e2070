/** The tools of the map editor: their keys, their signs, and what a stroke of each does. */
import { Crop, Eraser, Hand, PenLine, Ruler, Square, type LucideIcon } from "lucide-react";
import type { CellMap } from "@/map/floor/rosFiles";
import type { Point } from "@/map/plane/projection";
import { crop, drawAlong, fillBox, type Material } from "./cells/edits";

export type ToolName = "pan" | "brush" | "line" | "box" | "crop" | "measure";

export interface Tool {
  readonly name: ToolName;
  readonly key: string;
  readonly icon: LucideIcon;
  /** Whether a stroke keeps all its points, not just both ends. */
  readonly isFree?: boolean;
}

export const TOOLS: readonly Tool[] = [
  { name: "pan", key: "h", icon: Hand },
  { name: "line", key: "l", icon: PenLine },
  { name: "box", key: "b", icon: Square },
  { name: "brush", key: "e", icon: Eraser, isFree: true },
  { name: "crop", key: "c", icon: Crop },
  { name: "measure", key: "m", icon: Ruler },
];

export interface Settings {
  readonly tool: ToolName;
  /** What brush, line and box leave behind, each its own. */
  readonly material: Readonly<Record<ToolName, Material>>;
  /** Metres. */
  readonly width: Readonly<Record<ToolName, number>>;
}

const all = <Value>(value: Value): Record<ToolName, Value> => ({
  pan: value,
  brush: value,
  line: value,
  box: value,
  crop: value,
  measure: value,
});

export const FIRST_SETTINGS: Settings = {
  tool: "line",
  material: { ...all<Material>("wall"), brush: "floor" },
  width: { ...all(0.1), brush: 0.3 },
};

/** The points of a stroke after the hand has moved on; with `isStraight` along one axis. */
export function strokeOn(tool: Tool, stroke: readonly Point[], to: Point, isStraight: boolean): readonly Point[] {
  const [from] = stroke;
  if (!from) return [to];
  if (tool.isFree) return [...stroke, to];
  const isFlat = Math.abs(to[0] - from[0]) >= Math.abs(to[1] - from[1]);
  if (!isStraight || tool.name === "box" || tool.name === "crop") return [from, to];
  return [from, isFlat ? [to[0], from[1]] : [from[0], to[1]]];
}

/** The map after a stroke. */
export function applyStroke(map: CellMap, settings: Settings, stroke: readonly Point[]): CellMap {
  const { tool } = settings;
  const [from, to] = [stroke[0], stroke.at(-1)];
  if (!from || !to) return map;
  if (tool === "crop") return crop(map, from, to);
  if (tool === "box") return fillBox(map, from, to, settings.material.box);
  if (tool === "brush" || tool === "line") return drawAlong(map, stroke, settings.width[tool], settings.material[tool]);
  return map;
}
