/** Arrow keys walk through the changes, R restores the chosen one, Ctrl+Z takes the last restore back. */
import { useEffect, useRef } from "react";

interface Keys {
  walk: (by: 1 | -1) => void;
  restore: () => void;
  undo: () => void;
}

export function useCompareKeys(keys: Keys): void {
  const latest = useRef(keys);
  useEffect(() => {
    latest.current = keys;
  });
  useEffect(() => {
    const listen = (event: KeyboardEvent) => {
      if (isTaken(event)) return;
      const undoes = (event.ctrlKey || event.metaKey) && !event.shiftKey && event.key.toLowerCase() === "z";
      const plain = !event.ctrlKey && !event.metaKey && !event.altKey;
      if (undoes) latest.current.undo();
      else if (plain && event.key === "ArrowRight") latest.current.walk(1);
      else if (plain && event.key === "ArrowLeft") latest.current.walk(-1);
      else if (plain && event.key.toLowerCase() === "r") latest.current.restore();
      else return;
      event.preventDefault();
    };
    window.addEventListener("keydown", listen);
    return () => window.removeEventListener("keydown", listen);
  }, []);
}

/** Whoever types, chooses from a menu or answers a dialog means that. */
function isTaken(event: KeyboardEvent): boolean {
  const target = event.target instanceof Element ? event.target : null;
  return (
    event.defaultPrevented ||
    target?.closest("input, textarea, select, [role=menu], [role=dialog], [role=radiogroup], [role=tablist]") != null
  );
}
