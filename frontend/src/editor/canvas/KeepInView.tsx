/** On small screens the step in the sheet stays in sight: the map moves up when the sheet would lie over it. */
import { useEffect, useRef } from "react";
import { useStage } from "@/program/canvas/stageContext";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";

/** What the sheet takes of the window's height, and the bar of tools below it in pixels. */
const SHEET_SHARE = 0.46;
const TOOLS_PX = 90;
const MOVE_MS = 280;

export function KeepInView() {
  const { scene } = useOpenProgram();
  const { flow, pane, viewport } = useStage();
  const id = useUi((ui) => (ui.inspector ? (ui.selected.at(-1) ?? null) : null));
  const chips = useRef(scene.chips);
  useEffect(() => {
    chips.current = scene.chips;
  }, [scene]);
  useEffect(() => {
    const at = id === null ? undefined : chips.current.get(id)?.at;
    const free = pane.height - SHEET_SHARE * window.innerHeight - TOOLS_PX;
    const view = viewport.get();
    if (!at || at.y * view.zoom + view.y < free - 30) return;
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const middle = { x: (pane.width / 2 - view.x) / view.zoom, y: at.y + (pane.height - free) / 2 / view.zoom };
    void flow.setCenter(middle.x, middle.y, { zoom: view.zoom, duration: still ? 0 : MOVE_MS });
  }, [id, flow, pane.width, pane.height, viewport]);
  return null;
}
