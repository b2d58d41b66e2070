/** Texts that name a colour get a swatch of it. */
import type { Value } from "../model/types";

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
