/** A canvas that fills its parent at the screen's pixel density and draws when asked. */
import { useEffect, useRef, type RefObject } from "react";
import { watchPalette, type Palette } from "./palette";
import type { ViewportSource } from "./viewport";

export interface Painter {
  (context: CanvasRenderingContext2D, size: { width: number; height: number }, palette: Palette): void;
}

/** Repaints on a new painter, a resize, a theme change and each viewport change, at most once a frame. */
export function useCanvas(paint: Painter, viewport: ViewportSource): RefObject<HTMLCanvasElement | null> {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const element = canvas.current;
    const context = element?.getContext("2d");
    if (!element || !context) return;
    let palette: Palette | null = null;
    let frame = 0;
    const draw = () => {
      frame = 0;
      if (palette) paintOnce(element, context, paint, palette);
    };
    const ask = () => {
      if (!frame) frame = requestAnimationFrame(draw);
    };
    const stopPalette = watchPalette((next) => {
      palette = next;
      ask();
    });
    const stopViewport = viewport.subscribe(ask);
    const resize = new ResizeObserver(ask);
    resize.observe(element);
    void document.fonts?.ready.then(ask);
    return () => {
      stopPalette();
      stopViewport();
      resize.disconnect();
      cancelAnimationFrame(frame);
    };
  }, [paint, viewport]);
  return canvas;
}

/** Fits the canvas's pixels to its size on the screen, clears it and paints in CSS pixels. */
export function paintOnce(
  element: HTMLCanvasElement,
  context: CanvasRenderingContext2D,
  paint: Painter,
  palette: Palette,
): void {
  const density = window.devicePixelRatio || 1;
  const size = { width: element.clientWidth, height: element.clientHeight };
  const [width, height] = [Math.round(size.width * density), Math.round(size.height * density)];
  if (element.width !== width) element.width = width;
  if (element.height !== height) element.height = height;
  context.setTransform(density, 0, 0, density, 0, 0);
  context.clearRect(0, 0, size.width, size.height);
  paint(context, size, palette);
}
