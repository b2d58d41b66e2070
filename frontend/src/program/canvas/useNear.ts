/** Which constructs and lines are elements of the page, so that they can be pressed, dragged, read out and reached. */
import { useCallback, useEffect, useMemo, useState } from "react";
import { seenBox } from "@/map/plane/projection";
import type { ViewportCell } from "@/map/plane/viewport";
import { areNear, MOST_HELD } from "../scene/detail";
import { type LinePiece, type Pieces } from "../scene/pieces";
import type { Pointed } from "./usePointed";

export interface Near {
  /** What has an element now. */
  readonly mounted: ReadonlySet<string>;
  /** What the canvas is to leave out. */
  readonly without: ReadonlySet<string>;
  readonly onPainted: (without: ReadonlySet<string>) => void;
}

export interface Wanted {
  readonly pieces: Pieces;
  readonly viewport: ViewportCell;
  readonly size: { readonly width: number; readonly height: number };
  readonly pointed: Pointed;
  readonly selected: ReadonlySet<string>;
  readonly carried: ReadonlyMap<string, unknown> | undefined;
  readonly chosenLink: string | null | undefined;
}

const NONE: ReadonlySet<string> = new Set();

/**
 * An element stays until the canvas shows what it has shown, and is there before the canvas leaves it out, so that
 * nothing is ever missing.
 */
export function useNear(wanted: Wanted): Near {
  const { pieces, pointed, selected, carried, chosenLink } = wanted;
  const inView = useInView(wanted);
  const [painted, setPainted] = useState(NONE);
  const without = useMemo(() => {
    const held = [...firstOf(selected), ...firstOf(carried?.keys() ?? []), pointed.chip, pointed.focus];
    const chips = held.filter((id) => id !== null);
    return new Set([...inView, ...chips, ...linesOf(pieces, selected, pointed.line, chosenLink)]);
  }, [inView, pieces, selected, carried, pointed, chosenLink]);
  const mounted = useMemo(
    () => (painted === without ? without : new Set([...painted, ...without])),
    [painted, without],
  );
  return { mounted, without, onPainted: useCallback((now) => setPainted(now), []) };
}

/** The constructs in view once the map rests, if they can be read and are not too many. */
function useInView({ pieces, viewport, size }: Wanted): ReadonlySet<string> {
  const [inView, setInView] = useState(NONE);
  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | undefined;
    const look = () => {
      const view = viewport.get();
      const seen = pieces.chips.within(seenBox(view, size, AROUND));
      setInView((before) => {
        const now = areNear(view.zoom, seen.length, before.size > 0) ? new Set(seen.map(({ id }) => id)) : NONE;
        return isSame(before, now) ? before : now;
      });
    };
    const rest = () => {
      clearTimeout(timer);
      timer = setTimeout(look, REST_MS);
    };
    look();
    const stop = viewport.subscribe(rest);
    return () => {
      stop();
      clearTimeout(timer);
    };
  }, [pieces, viewport, size]);
  return inView;
}

/** Pixels of the screen over the edges of the pane. */
const AROUND = 60;
/** So long the map has not moved. */
const REST_MS = 120;

function isSame(one: ReadonlySet<string>, other: ReadonlySet<string>): boolean {
  return one.size === other.size && [...one].every((id) => other.has(id));
}

/** Of more than can be held at once none: the canvas shows them as selected. */
function firstOf(ids: Iterable<string>): string[] {
  const all = [...ids];
  return all.length <= MOST_HELD ? all : [];
}

/** The lines at what is selected, the one under the pointer, the one that the next step goes to. */
function linesOf(
  { lines }: Pieces,
  selected: ReadonlySet<string>,
  pointed: string | null,
  chosenLink: string | null | undefined,
): string[] {
  const few = selected.size <= MOST_HELD ? selected : NONE;
  return lines.items.filter((line) => line.id === pointed || isAt(line, few, chosenLink)).map(({ id }) => id);
}

function isAt(line: LinePiece, selected: ReadonlySet<string>, chosenLink: string | null | undefined): boolean {
  if ("route" in line) return line.route.steps.some(({ step }) => selected.has(step));
  if (!("link" in line)) return false;
  const { id, from, to } = line.link;
  return id === chosenLink || [from, to].some((step) => step !== null && selected.has(step));
}
