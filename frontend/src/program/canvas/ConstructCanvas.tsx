/** Constructs and lines that are no elements, on one canvas. */
import { useEffect, useRef } from "react";
import type { ViewportSource } from "@/map/plane/viewport";
import type { PaintedLooks } from "../painting/looks";
import type { Pieces } from "../scene/pieces";
import { ConstructPainter } from "../painting/constructPainter";
import classes from "./stage.module.css";

interface ConstructCanvasProps {
  viewport: ViewportSource;
  pieces: Pieces;
  looks: PaintedLooks;
  without: ReadonlySet<string>;
  /** Called when the canvas shows all but these. */
  onPainted?: (without: ReadonlySet<string>) => void;
  count?: number;
}

export function ConstructCanvas({ viewport, pieces, looks, without, onPainted, count }: ConstructCanvasProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const painter = useRef<ConstructPainter | null>(null);
  useEffect(() => {
    const context = canvas.current?.getContext("2d");
    if (!canvas.current || !context) return;
    const made = new ConstructPainter(canvas.current, context, viewport, onPainted);
    painter.current = made;
    return () => made.end();
  }, [viewport, onPainted]);
  useEffect(
    () => painter.current?.show({ pieces, looks, without, count }),
    [pieces, looks, without, count, viewport, onPainted],
  );
  return <canvas ref={canvas} className={classes.constructs} aria-hidden="true" />;
}
