/** The fonts in which constructs are written, and how wide words are in them. */

export const FONTS = {
  chip: "600 12px 'Inter Variable', Inter, sans-serif",
  soft: "500 12px 'Inter Variable', Inter, sans-serif",
  strong: "700 12px 'Inter Variable', Inter, sans-serif",
  badge: "700 11px 'Inter Variable', Inter, sans-serif",
  mono: "500 11.5px 'JetBrains Mono', monospace",
} as const;

/** So many widths are kept; numbers and words of a program are fewer. */
const MOST_KNOWN = 20_000;
const known = new Map<string, number>();
let context: CanvasRenderingContext2D | null = null;

/** How wide a text is, pixels of the drawing plane. */
export function measureText(text: string, font: keyof typeof FONTS): number {
  const key = `${font}\n${text}`;
  const before = known.get(key);
  if (before !== undefined) return before;
  context ??= document.createElement("canvas").getContext("2d");
  if (!context) return text.length * 7;
  context.font = FONTS[font];
  const width = context.measureText(text).width;
  if (known.size >= MOST_KNOWN) known.clear();
  // A width measured before the fonts have come is not kept.
  if (document.fonts?.status === "loaded") known.set(key, width);
  return width;
}
