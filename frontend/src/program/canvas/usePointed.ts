/** What lies under the pointer and what has the keyboard, among constructs that are only painted. */
import { useReactFlow } from "@xyflow/react";
import { type FocusEvent, type PointerEvent, useCallback, useMemo, useRef, useState } from "react";
import { flushSync } from "react-dom";
import { chipAt, lineAt, type Pieces } from "../scene/pieces";

export interface Pointed {
  readonly chip: string | null;
  readonly line: string | null;
  readonly focus: string | null;
}

export interface Pointing {
  readonly pointed: Pointed;
  readonly onMove: (event: PointerEvent) => void;
  readonly onLeave: () => void;
  readonly onFocus: (event: FocusEvent) => void;
  readonly onBlur: () => void;
}

/** Pixels of the screen to each side of a line. */
export const LINE_REACH = 8;
const NOTHING: Pointed = { chip: null, line: null, focus: null };

/** What is pointed at becomes an element before the press arrives, so that it is pressed and dragged as any other. */
export function usePointed(pieces: Pieces, active: boolean): Pointing {
  const flow = useReactFlow();
  const [pointed, setPointed] = useState(NOTHING);
  const now = useRef(NOTHING);
  const turn = useCallback((change: Partial<Pointed>) => {
    const next = { ...now.current, ...change };
    const { chip, line, focus } = now.current;
    if (next.chip === chip && next.line === line && next.focus === focus) return;
    now.current = next;
    flushSync(() => setPointed(next));
  }, []);
  const onMove = useCallback(
    (event: PointerEvent) => {
      if (event.buttons !== 0 || event.pointerType === "touch") return;
      const on = nodeUnder(event.target);
      if (on !== null) turn({ chip: on, line: null });
      else if (active && isFloor(event.target)) {
        const at = flow.screenToFlowPosition({ x: event.clientX, y: event.clientY }, { snapToGrid: false });
        const chip = chipAt(pieces, at)?.id ?? null;
        turn({ chip, line: chip === null ? (lineAt(pieces, at, LINE_REACH / flow.getZoom())?.id ?? null) : null });
      }
    },
    [pieces, active, flow, turn],
  );
  return useMemo(
    () => ({
      pointed,
      onMove,
      onLeave: () => turn({ chip: null, line: null }),
      onFocus: (event) => turn({ focus: nodeUnder(event.target) }),
      onBlur: () => turn({ focus: null }),
    }),
    [pointed, onMove, turn],
  );
}

function nodeUnder(target: EventTarget | null): string | null {
  return target instanceof Element ? (target.closest(".react-flow__node")?.getAttribute("data-id") ?? null) : null;
}

function isFloor(target: EventTarget | null): boolean {
  return target instanceof Element && target.closest(".react-flow__pane") !== null;
}
