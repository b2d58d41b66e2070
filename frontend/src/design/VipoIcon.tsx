/** VIPO's own icons (`icons/*.svg`), 24 px grid, drawn in the text's colour. */
import { ownEntry } from "./ownEntry";

const sources = import.meta.glob<string>("../icons/*.svg", { query: "?raw", import: "default", eager: true });

const bodies: Record<string, string> = Object.fromEntries(
  Object.entries(sources).map(([path, source]) => [
    path.replace(/^.*\/|\.svg$/g, ""),
    source.replace(/^[\s\S]*?<svg[^>]*>|<\/svg>\s*$/g, ""),
  ]),
);

export function hasVipoIcon(name: string): boolean {
  return Object.hasOwn(bodies, name);
}

/** What stands inside an icon's svg element, for canvases; empty where there is no such icon. */
export function iconBody(name: string): string {
  return ownEntry(bodies, name) ?? "";
}

/** Decoration only: whoever uses it gives the name in words beside it or in a label. */
export function VipoIcon({ name, size = 18, x, y }: { name: string; size?: number; x?: number; y?: number }) {
  return (
    <svg
      width={size}
      height={size}
      x={x}
      y={y}
      viewBox="0 0 24 24"
      fill="none"
      stroke="currentColor"
      strokeWidth={size <= 15 ? 2 : 1.75}
      strokeLinecap="round"
      strokeLinejoin="round"
      aria-hidden="true"
      dangerouslySetInnerHTML={{ __html: iconBody(name) }}
    />
  );
}
