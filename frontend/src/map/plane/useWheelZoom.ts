/** The wheel zooms what an element shows, at the pointer; where it changes nothing, the page scrolls. */
import { type RefObject, useEffect, useRef } from "react";

/** `zoom` is told by how much and where, in pixels of the element; false: it did nothing. */
export function useWheelZoom(
  surface: RefObject<Element | null>,
  zoom: (factor: number, x: number, y: number) => boolean,
): void {
  const latest = useRef(zoom);
  useEffect(() => {
    latest.current = zoom;
  });
  useEffect(() => {
    const element = surface.current;
    const turn = (event: Event) => {
      if (!(event instanceof WheelEvent)) return;
      const box = element?.getBoundingClientRect();
      const [x, y] = [event.clientX - (box?.left ?? 0), event.clientY - (box?.top ?? 0)];
      if (latest.current(Math.exp(-event.deltaY / 400), x, y)) event.preventDefault();
    };
    element?.addEventListener("wheel", turn, { passive: false });
    return () => element?.removeEventListener("wheel", turn);
  }, [surface]);
}
