/** Constructs and lines that are no elements, on one canvas. */
import { useEffect, useRef, useState } from "react";
import type { ViewportSource } from "@/map/plane/viewport";
import type { PaintedLooks } from "../painting/looks";
import type { Pieces } from "../scene/pieces";
import type { ConstructPainter } from "../painting/constructPainter";
import classes from "./stage.module.css";

/** Fetched beside the program, which is longer on its way; elements do not wait for it. */
const loading = import("../painting/constructPainter");

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
  const [painter, setPainter] = useState<ConstructPainter | null>(null);
  useEffect(() => {
    let made: ConstructPainter | null = null;
    let ended = false;
    void loading.then(({ ConstructPainter: Painter }) => {
      const context = canvas.current?.getContext("2d");
      if (ended || !canvas.current || !context) return;
      made = new Painter(canvas.current, context, viewport, onPainted);
      setPainter(made);
    });
    return () => {
      ended = true;
      made?.end();
    };
  }, [viewport, onPainted]);
  useEffect(() => painter?.show({ pieces, looks, without, count }), [painter, pieces, looks, without, count]);
  return <canvas ref={canvas} className={classes.constructs} aria-hidden="true" />;
}
