/** A tool dragged from the rail onto the map: let go, its construct stands there. */
import { useCallback, useEffect, useRef, useState, type PointerEvent as Press } from "react";
import type { OpenProgram } from "../state/context";
import type { Command } from "../commands/command";
import { runCommand } from "../commands/keys";
import { drawAt } from "../state/drawAt";
import { underPointer } from "../state/under";

/** A shorter way is a press, pixels. */
const SLIP_PX = 6;

export interface DraggedTool {
  readonly kind: string;
  readonly x: number;
  readonly y: number;
}

/**
 * What is dragged now, and what begins it. A press that became a drag takes no tool: `wasDragged` says so once.
 * What is returned to call stays the same whatever happens to the program.
 */
export function useToolDrag(open: OpenProgram) {
  const [dragged, setDragged] = useState<DraggedTool | null>(null);
  const latest = useRef(open);
  const moved = useRef(false);
  const stop = useRef<(() => void) | null>(null);
  useEffect(() => {
    latest.current = open;
  }, [open]);
  useEffect(() => () => stop.current?.(), []);
  const begin = useCallback((kind: string, press: Press) => {
    if (press.button !== 0) return;
    moved.current = false;
    stop.current?.();
    stop.current = followPointer(press.nativeEvent, {
      onMove: (at) => {
        moved.current = true;
        setDragged({ kind, ...at });
      },
      onEnd: (at) => {
        setDragged(null);
        const under = at && isOverMap(at) ? underPointer(latest.current, at) : null;
        if (under) drawAt(latest.current, kind, under);
      },
    });
  }, []);
  const wasDragged = useCallback(() => {
    const was = moved.current;
    moved.current = false;
    return was;
  }, []);
  const run = useCallback((command: Command) => runCommand(latest.current, command), []);
  return { dragged, begin, wasDragged, run };
}

interface Following {
  readonly onMove: (at: { x: number; y: number }) => void;
  /** Null where it was given up, with Esc. */
  readonly onEnd: (at: { x: number; y: number } | null) => void;
}

/** From the press until the pointer is let go; returns how to stop listening. */
function followPointer(from: PointerEvent, { onMove, onEnd }: Following): () => void {
  let far = false;
  const listening = new AbortController();
  const move = (event: PointerEvent) => {
    if (event.pointerId !== from.pointerId) return;
    far ||= Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > SLIP_PX;
    if (far) onMove({ x: event.clientX, y: event.clientY });
  };
  const end = (at: { x: number; y: number } | null) => {
    listening.abort();
    if (far) onEnd(at);
  };
  const up = (event: PointerEvent) => {
    if (event.pointerId === from.pointerId) end({ x: event.clientX, y: event.clientY });
  };
  const leave = (event: KeyboardEvent) => {
    if (event.key !== "Escape" || !far) return;
    event.preventDefault();
    event.stopPropagation();
    end(null);
  };
  const { signal } = listening;
  window.addEventListener("pointermove", move, { signal });
  window.addEventListener("pointerup", up, { signal });
  window.addEventListener("pointercancel", () => end(null), { signal });
  window.addEventListener("keydown", leave, { signal, capture: true });
  return () => listening.abort();
}

/** Not over a panel that lies on the map. */
function isOverMap({ x, y }: { x: number; y: number }): boolean {
  const under = document.elementFromPoint(x, y);
  return under?.closest("[data-map]") !== null && under?.closest("button, aside, section") === null;
}
