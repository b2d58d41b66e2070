/** Which pins stand on the map: one for each commented thing with threads that are open, gathered where they are near. */
import type { Thread } from "@/api/types";
import type { PixelPoint } from "@/map/plane/paths";
import type { OpenProgram } from "../state/context";
import { placeOf, stepOf } from "./about";

export interface Pin {
  readonly key: string;
  readonly at: PixelPoint;
  /** The threads of it, the last written in first. */
  readonly threads: readonly string[];
  readonly unread: number;
  /** The steps that it stands for: one, or several that are too near to each other to have one each. */
  readonly steps: readonly string[];
  /** How many things it stands for. */
  readonly things: number;
}

/** The pins of all that has open threads and a place, in the order of the threads; costs as much as there are threads. */
export function pinsOf(threads: readonly Thread[], open: Pick<OpenProgram, "document" | "scene">): Pin[] {
  const pins = new Map<string, Pin>();
  for (const thread of threads) {
    const at = thread.resolved_at === null ? placeOf(open, thread) : null;
    if (!at) continue;
    const step = stepOf(open, thread);
    const key = step ?? `${at.x} ${at.y}`;
    const own = { key, at, threads: [thread.id], unread: thread.unread, steps: step === null ? [] : [step], things: 1 };
    const before = pins.get(key);
    pins.set(key, before ? { ...joined(before, own), things: 1 } : own);
  }
  return [...pins.values()];
}

/** Pixels of the screen: nearer pins become one, so that each can be read and pressed. */
const APART = 30;

/** The pins of a zoom: those that would lie on each other are one, where the first of them is. */
export function gatherPins(pins: readonly Pin[], zoom: number): Pin[] {
  const cell = APART / zoom;
  const gathered = new Map<string, Pin>();
  for (const pin of pins) {
    const key = `${Math.floor(pin.at.x / cell)} ${Math.floor(pin.at.y / cell)}`;
    const before = gathered.get(key);
    gathered.set(key, before ? joined(before, pin) : pin);
  }
  return [...gathered.values()];
}

function joined(one: Pin, other: Pin): Pin {
  return {
    ...one,
    threads: [...one.threads, ...other.threads],
    unread: one.unread + other.unread,
    steps: [...new Set([...one.steps, ...other.steps])],
    things: one.things + other.things,
  };
}

/** Zooms for which pins are gathered alike: so nothing is gathered anew while the map is only moved. */
export function levelOf(zoom: number): number {
  return 2 ** (Math.round(Math.log2(zoom) * 2) / 2);
}
