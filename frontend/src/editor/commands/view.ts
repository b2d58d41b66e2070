/** Commands that move the map's view. */
import { Expand, Focus, Radio, RotateCcw, ZoomIn, ZoomOut } from "lucide-react";
import { leastZoom } from "@/map/floor/floor";
import type { Box } from "@/map/plane/projection";
import { outerBox } from "@/program/scene/scene";
import type { OpenProgram } from "../state/context";
import { useScreen } from "../state/screen";
import { select } from "../state/ui";
import { command, type Command } from "./command";

const STEP_MS = 180;
const FLIGHT_MS = 280;
/** Nothing is brought nearer than this. */
const NEAREST = 1.4;
/** Around what is brought into view, so that it stands clear of the panels, pixels of the screen. */
const MARGIN = { x: 420, y: 360 };

function flight(): number {
  return matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : FLIGHT_MS;
}

/** Bring steps into the midst of the view, as near as they all fit. */
export function showSteps({ scene, plan }: Pick<OpenProgram, "scene" | "plan">, steps: readonly string[]): boolean {
  const { stage } = useScreen.getState();
  const boxes = steps.flatMap((id) => outerBox(scene, id) ?? scene.chips.get(id)?.box ?? []);
  if (!stage || boxes.length === 0) return false;
  const around = boxAround(boxes);
  const room = { x: Math.max(200, stage.pane.width - MARGIN.x), y: Math.max(160, stage.pane.height - MARGIN.y) };
  const zoom = Math.min(NEAREST, room.x / (around.right - around.left), room.y / (around.bottom - around.top));
  const [x, y] = [(around.left + around.right) / 2, (around.top + around.bottom) / 2];
  void stage.flow.setCenter(x, y, { zoom: Math.max(leastZoom(plan), zoom), duration: flight() });
  return true;
}

function boxAround(boxes: readonly Box[]): Box {
  return {
    left: Math.min(...boxes.map((box) => box.left)),
    right: Math.max(...boxes.map((box) => box.right)),
    top: Math.min(...boxes.map((box) => box.top)),
    bottom: Math.max(...boxes.map((box) => box.bottom)),
  };
}

function stageMoves(move: (stage: NonNullable<ReturnType<typeof useScreen.getState>["stage"]>) => unknown) {
  return () => {
    const { stage } = useScreen.getState();
    if (stage) move(stage);
  };
}

const VIEW = { group: "view" } as const;

export const VIEW_COMMANDS: readonly Command[] = [
  command({
    id: "zoom_in",
    ...VIEW,
    icon: ZoomIn,
    keys: ["+"],
    run: stageMoves(({ flow }) => flow.zoomIn({ duration: STEP_MS })),
  }),
  command({
    id: "zoom_out",
    ...VIEW,
    icon: ZoomOut,
    keys: ["-"],
    run: stageMoves(({ flow }) => flow.zoomOut({ duration: STEP_MS })),
  }),
  command({
    id: "zoom_full",
    ...VIEW,
    icon: RotateCcw,
    keys: ["0"],
    run: stageMoves(({ flow }) => flow.zoomTo(1, { duration: STEP_MS })),
  }),
  command({
    id: "zoom_fit",
    ...VIEW,
    icon: Expand,
    keys: ["1"],
    menus: ["floor"],
    run: stageMoves(({ fit }) => fit()),
  }),
  command({
    id: "zoom_selection",
    ...VIEW,
    icon: Focus,
    keys: ["2"],
    when: "steps",
    menus: ["step"],
    whyNot: (_open, { steps }) => (steps.length > 0 ? null : "commands.why.no_steps"),
    run: (open, { steps }) => showSteps(open, steps),
  }),
  command({
    id: "zoom_running",
    ...VIEW,
    icon: Radio,
    keys: ["3"],
    whyNot: () => (useScreen.getState().running.length > 0 ? null : "commands.why.nothing_runs"),
    run: (open) => {
      const { running } = useScreen.getState();
      select(running.filter((id) => open.scene.chips.has(id)));
      return showSteps(open, running);
    },
  }),
];
