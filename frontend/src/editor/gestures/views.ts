/** What part of the map somebody sees: its middle and how wide it is, metres; pure. */
import { PIXELS_PER_METRE } from "@/map/projection";

export type SharedView = readonly [x: number, y: number, width: number];

/** What another client says, if it makes sense. */
export function viewFrom(value: unknown): SharedView | null {
  if (!Array.isArray(value) || value.length !== 3) return null;
  const [x, y, width] = value as unknown[];
  const sound = [x, y, width].every((each) => typeof each === "number" && Number.isFinite(each));
  return sound && (width as number) > 0 ? [x as number, y as number, width as number] : null;
}

/** The zoom at which a pane shows as much from left to right, within what the map allows. */
export function zoomFor([, , width]: SharedView, paneWidth: number): number {
  return Math.min(3, Math.max(0.2, paneWidth / (width * PIXELS_PER_METRE)));
}
