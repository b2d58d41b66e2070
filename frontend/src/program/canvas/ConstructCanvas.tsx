/** Constructs and lines that are no elements, on one canvas. */
import { useEffect, useRef, useState } from "react";
import type { ViewportSource } from "@/map/plane/viewport";
import type { PaintedLooks } from "../painting/looks";
import type { Pieces } from "../scene/pieces";
import type { ConstructPainter } from "../painting/constructPainter";
import classes from "./stage.module.css";

const fetchPainter = () => import("../painting/constructPainter");
/** Fetched beside the program, which is longer on its way; elements do not wait for it. */
const first = fetchPainter().catch(() => null);
const AGAIN_MS = 3000;

/** What could not be fetched is asked for again for as long as the map is there: without it no line is seen. */
async function loadPainter(isOver: () => boolean) {
  for (let found = await first; ; found = await fetchPainter().catch(() => null)) {
    if (found || isOver()) return found;
    await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
  }
}

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
    void loadPainter(() => ended).then((found) => {
      const context = canvas.current?.getContext("2d");
      if (ended || !found || !canvas.current || !context) return;
      made = new found.ConstructPainter(canvas.current, context, viewport, onPainted);
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
