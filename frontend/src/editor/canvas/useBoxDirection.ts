/** A box drawn to the right takes what is fully inside, one drawn to the left whatever it touches. */
import { SelectionMode } from "@xyflow/react";
import { useCallback, useRef, useState } from "react";

export function useBoxDirection() {
  const [touching, setTouching] = useState(false);
  const start = useRef<number | null>(null);
  const begin = useCallback((event: { clientX: number }) => {
    start.current = event.clientX;
  }, []);
  const watch = useCallback((event: { clientX: number; buttons: number }) => {
    if (start.current !== null && event.buttons > 0) setTouching(event.clientX < start.current);
  }, []);
  const end = useCallback(() => {
    start.current = null;
    setTouching(false);
  }, []);
  return { mode: touching ? SelectionMode.Partial : SelectionMode.Full, begin, watch, end };
}
