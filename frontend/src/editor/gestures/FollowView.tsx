/** One's own view shown to the others, and somebody else's view followed until one moves the map oneself. */
import { useEffect } from "react";
import { type FloorPlan, leastZoom } from "@/map/floor/floor";
import { PIXELS_PER_METRE, toMetres, toPixels } from "@/map/plane/projection";
import { useStage } from "@/program/canvas/stageContext";
import type { SharedProgram } from "../shared/sharedProgram";
import { useOpenProgram } from "../state/context";
import { useGestures } from "../state/gestures";

const TELL_EVERY_MS = 150;

export function FollowView() {
  const { shared, plan } = useOpenProgram();
  useTellView(shared);
  useFollow(shared, plan);
  return null;
}

function useTellView(shared: SharedProgram): void {
  const { viewport, pane } = useStage();
  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | undefined;
    const tell = () => {
      timer = undefined;
      const { x, y, zoom } = viewport.get();
      const centre = toMetres({ x: (pane.width / 2 - x) / zoom, y: (pane.height / 2 - y) / zoom });
      const width = Math.round((toMetres({ x: pane.width / zoom, y: 0 })[0] ?? 0) * 10) / 10;
      shared.awareness.setLocalStateField("view", [...centre, width]);
    };
    const soon = () => (timer ??= setTimeout(tell, TELL_EVERY_MS));
    soon();
    const stop = viewport.subscribe(soon);
    return () => {
      stop();
      clearTimeout(timer);
    };
  }, [shared, viewport, pane.width, pane.height]);
}

function useFollow(shared: SharedProgram, plan: FloorPlan | null): void {
  const { flow, pane } = useStage();
  const following = useGestures((ui) => ui.following);
  useEffect(() => {
    if (following === null) return;
    let last: SharedView | null = null;
    const go = () => {
      const state = shared.awareness.getStates().get(following) as { view?: unknown } | undefined;
      if (!state) useGestures.setState({ following: null });
      const view = viewFrom(state?.view);
      if (!view || view.join() === last?.join()) return;
      last = view;
      const at = toPixels([view[0], view[1]]);
      void flow.setCenter(at.x, at.y, { zoom: zoomFor(view, pane.width, plan), duration: TELL_EVERY_MS });
    };
    go();
    shared.awareness.on("change", go);
    return () => shared.awareness.off("change", go);
  }, [shared, plan, following, flow, pane.width]);
}

export type SharedView = readonly [x: number, y: number, width: number];

/** What another client says, if it makes sense. */
export function viewFrom(value: unknown): SharedView | null {
  if (!Array.isArray(value) || value.length !== 3) return null;
  const [x, y, width] = value as unknown[];
  const sound = [x, y, width].every((each) => typeof each === "number" && Number.isFinite(each));
  return sound && (width as number) > 0 ? [x as number, y as number, width as number] : null;
}

/** The zoom at which a pane shows as much from left to right, within what the map allows. */
export function zoomFor([, , width]: SharedView, paneWidth: number, plan: FloorPlan | null): number {
  return Math.min(3, Math.max(leastZoom(plan), paneWidth / (width * PIXELS_PER_METRE)));
}
