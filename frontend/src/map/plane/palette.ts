/** Colours of the design tokens for canvases, read from the page and renewed when the theme changes. */

const NAMES = [
  "void",
  "floor",
  "grid",
  "grid-2",
  "wall",
  "wall-edge",
  "wall-soft",
  "panel",
  "line",
  "text",
  "text-2",
  "text-3",
  "machine-fill",
  "machine-line",
  "brand",
  "idle",
  "busy",
  "busy-soft",
  "done",
  "warn",
  "warn-fill",
  "error",
  "offline",
  "pend",
  "casing",
  "motion",
  "motion-soft",
  "machine",
  "machine-soft",
  "logic",
  "logic-soft",
  "func",
  "func-soft",
  "note",
  "note-soft",
  "note-line",
  "done-soft",
  "error-soft",
] as const;

export type PaletteName = (typeof NAMES)[number];
export type Palette = Readonly<Record<PaletteName, string>>;

export function readPalette(): Palette {
  const style = getComputedStyle(document.documentElement);
  const entries = NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()] as const);
  return Object.fromEntries(entries) as Palette;
}

/** Calls back with the palette now and after each change of theme; returns how to stop. */
export function watchPalette(listener: (palette: Palette) => void): () => void {
  listener(readPalette());
  const observer = new MutationObserver(() => listener(readPalette()));
  observer.observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
  return () => observer.disconnect();
}
