/** Widths of chip texts, measured once each; chips get their sizes before they are drawn. */
import type { Measure } from "../scene/chips";

const FONTS = {
  chip: "600 12px 'Inter Variable', Inter, sans-serif",
  badge: "700 11px 'Inter Variable', Inter, sans-serif",
  mono: "500 11.5px 'JetBrains Mono', monospace",
} as const;

const known = new Map<string, number>();
let context: CanvasRenderingContext2D | null = null;

export const measureText: Measure = (text, font) => {
  const key = `${font}\n${text}`;
  const before = known.get(key);
  if (before !== undefined) return before;
  context ??= document.createElement("canvas").getContext("2d");
  if (!context) return text.length * 7;
  context.font = FONTS[font];
  const width = context.measureText(text).width;
  // A width measured before the fonts have come is not kept.
  if (document.fonts?.status === "loaded") known.set(key, width);
  return width;
};
