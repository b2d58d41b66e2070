/** Where the word of an arrow stands: beside its first stretch. */
import type { Box } from "@/map/projection";
import { pathLength, pointAlong } from "@/map/routePath";
import type { Link } from "./links";

export interface WordPlace {
  readonly x: number;
  readonly y: number;
  /** Over a flat stretch the word stands in the middle, beside a steep one it begins there. */
  readonly anchor: "middle" | "start";
}

const ALONG = 24;
const LETTER = 6.6;

export function wordPlace(link: Pick<Link, "points">): WordPlace | null {
  const at = pointAlong(link.points, Math.min(ALONG, pathLength(link.points) / 2));
  if (!at) return null;
  const flat = Math.abs(at.angle) < 45 || Math.abs(at.angle) > 135;
  return flat ? { x: at.x, y: at.y - 7, anchor: "middle" } : { x: at.x + 8, y: at.y + 4, anchor: "start" };
}

/** About the room that the word takes. */
export function wordBox(link: Pick<Link, "points" | "word">): Box | null {
  const place = link.word ? wordPlace(link) : null;
  if (!place || !link.word) return null;
  const width = link.word.length * LETTER;
  const left = place.anchor === "middle" ? place.x - width / 2 : place.x;
  return { left, right: left + width, top: place.y - 11, bottom: place.y + 4 };
}
