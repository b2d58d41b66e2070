/** What the mode of the keyboard is about to do, for who looks; who listens hears it from the announcer. */
import { useEffect } from "react";
import { useTranslation } from "react-i18next";
import { toPixels } from "@/map/plane/projection";
import { useStage } from "@/program/canvas/stageContext";
import stage from "@/program/canvas/stage.module.css";
import { useOpenProgram } from "../state/context";
import classes from "./keyboard.module.css";
import { type Mode, useMode } from "./modes";

export function ModeBar() {
  const { t } = useTranslation();
  const mode = useMode((state) => state.mode);
  const words = useMode((state) => state.words);
  if (!mode) return null;
  return (
    <div className={classes.bar} data-mode={mode.kind}>
      <b>{t(`access.mode.${mode.kind}`)}</b>
      <span>{words}</span>
      <small>{t(`access.keys.${mode.kind}`)}</small>
    </div>
  );
}

/** In the map's plane: where the step would go, or which step the arrow would lead to. */
export function ModeMark() {
  const mode = useMode((state) => state.mode);
  const at = useMarked(mode);
  if (!at) return null;
  return (
    <svg className={stage.drawing} width={1} height={1} aria-hidden="true">
      <g transform={`translate(${at.x} ${at.y})`} className={classes.mark}>
        <circle r={16} />
        <path d="M-26 0H-8M8 0H26M0 -26V-8M0 8V26" />
      </g>
    </svg>
  );
}

function useMarked(mode: Mode | null) {
  const { scene } = useOpenProgram();
  if (!mode) return null;
  if (mode.kind === "place") return toPixels(mode.at);
  const id = mode.kind === "connect" ? mode.targets[mode.at] : mode.spots[mode.at]?.beside;
  return scene.chips.get(id ?? "")?.at ?? null;
}

const MARGIN_PX = 80;

/** Brings what the mode is at into sight, at once and without a flight. */
export function ModeInView() {
  const mode = useMode((state) => state.mode);
  const at = useMarked(mode);
  const { flow, pane, viewport } = useStage();
  useEffect(() => {
    if (!at) return;
    const view = viewport.get();
    const [x, y] = [at.x * view.zoom + view.x, at.y * view.zoom + view.y];
    const seen = x > MARGIN_PX && y > MARGIN_PX && x < pane.width - MARGIN_PX && y < pane.height - MARGIN_PX;
    if (!seen) void flow.setCenter(at.x, at.y, { zoom: view.zoom, duration: 0 });
  }, [at, flow, pane.width, pane.height, viewport]);
  return null;
}
