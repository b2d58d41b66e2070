/** Something that stays at a point of the map, in its own size, while the map is moved. */
import { useLayoutEffect, useRef, type ReactNode } from "react";
import type { PixelPoint } from "@/map/plane/paths";
import classes from "@/program/canvas/stage.module.css";
import { useStage } from "@/program/canvas/stageContext";

export function FloatAt({ at, dy = 0, children }: { at: PixelPoint; dy?: number; children: ReactNode }) {
  const element = useRef<HTMLDivElement>(null);
  const { viewport } = useStage();
  useLayoutEffect(() => {
    const place = () => {
      const view = viewport.get();
      const [x, y] = [at.x * view.zoom + view.x, at.y * view.zoom + view.y + dy];
      if (element.current) element.current.style.transform = `translate(${x}px, ${y}px)`;
    };
    place();
    return viewport.subscribe(place);
  }, [viewport, at.x, at.y, dy]);
  return (
    <div ref={element} className={classes.float}>
      <div className={classes.floatInner}>{children}</div>
    </div>
  );
}
