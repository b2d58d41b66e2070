/** Measured paces, as screens say them; pure. A pace is what a device took divided by what its copy took. */
import type { Measured, MethodPace, StepMeasured } from "@/api/types";

/** Less than this part is not worth a word. */
const NOTICED = 0.03;

/** In percent how much longer than its model something takes; 0 where that is as good as the same. */
export function percentOver(pace: number): number {
  return Math.abs(pace - 1) < NOTICED ? 0 : Math.round(100 * (pace - 1));
}

export function paceOf({ real_s, predicted_s }: Measured): number {
  return real_s / predicted_s;
}

export interface Strip {
  readonly dots: readonly { readonly x: number; readonly y: number; readonly newest: boolean }[];
  /** Where the model's own time is, and the band: heights from 0 (top) to 1. */
  readonly model: number;
  readonly band: readonly [number, number];
  readonly low: number;
  readonly high: number;
}

const RECENT = 10;

/** The newest paces from left to right on a scale that shows the model's time, too. */
export function stripOf({ newest, band }: Pick<MethodPace, "newest" | "band">): Strip | null {
  const paces = newest.map(paceOf);
  if (paces.length === 0 || !band) return null;
  const [low, high] = [Math.min(...paces, 1), Math.max(...paces, 1)];
  const margin = Math.max(0.05, (high - low) * 0.15);
  const height = (pace: number) => 1 - (clamp(pace, low, high) - low + margin) / (high - low + 2 * margin);
  return {
    dots: paces.map((pace, index) => ({
      x: (index + 0.5) / paces.length,
      y: height(pace),
      newest: index >= paces.length - RECENT,
    })),
    model: height(1),
    band: [height(band[1] ?? high), height(band[0] ?? low)],
    low: Math.min(...paces),
    high: Math.max(...paces),
  };
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, value));
}

/** What each step of a run took at work, and what was predicted; several commands of one step together. */
export function byStep(measured: readonly StepMeasured[]): ReadonlyMap<string, Measured> {
  const found = new Map<string, Measured>();
  for (const { step, real_s, predicted_s } of measured) {
    const before = found.get(step) ?? { real_s: 0, predicted_s: 0 };
    found.set(step, { real_s: before.real_s + real_s, predicted_s: before.predicted_s + predicted_s });
  }
  return found;
}
