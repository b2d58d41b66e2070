/** The menu over a step, an arrow, a machine or the floor, on the map and in the list of steps. */
import { lazy, Suspense, useCallback, useEffect } from "react";
import { useFetchLater } from "@/design/useFetchLater";
import { useOpenProgram, type OpenProgram } from "../state/context";
import { useGestures } from "../state/gestures";
import { useLongPress } from "../gestures/longPress";
import { underPointer } from "../state/under";
import { useUi } from "../state/ui";
import { menuOver, showMenu } from "./menu";
import { COMMANDS } from "./table";

const loadItems = () => import("./MenuItems");
const LOADS = [loadItems];
const MenuItems = lazy(async () => ({ default: (await loadItems()).MenuItems }));

export function ContextMenu() {
  const open = useOpenProgram();
  const menu = useGestures((ui) => ui.menu);
  useRightClick(open);
  useLongPress(useCallback((press) => ask(open, press.target, { x: press.clientX, y: press.clientY }), [open]));
  useFetchLater(LOADS);
  return menu ? (
    <Suspense fallback={null}>
      <MenuItems menu={menu} />
    </Suspense>
  ) : null;
}

/** With a tool in hand a right click steps back instead. */
function mayAsk(): boolean {
  const { gesture, dialog } = useUi.getState();
  return !dialog && (gesture.tool === "select" || gesture.tool === "pan");
}

/** What was pressed, in the list or on the map; null elsewhere. */
function pressed(open: OpenProgram, target: EventTarget | null, at: { x: number; y: number }) {
  if (!(target instanceof Element)) return null;
  const row = target.closest("[data-step]")?.getAttribute("data-step");
  if (row && row in open.document.steps) return { step: row, link: null, device: null, at: [0, 0] as const };
  const onMap = target.closest(".react-flow__pane, .react-flow__node, .react-flow__viewport");
  return onMap && target.closest("[data-map]") ? underPointer(open, at) : null;
}

function ask(open: OpenProgram, target: EventTarget | null, at: { x: number; y: number }): boolean {
  const under = mayAsk() ? pressed(open, target, at) : null;
  if (under) showMenu(COMMANDS, open, menuOver(under), at);
  return under !== null;
}

function useRightClick(open: OpenProgram): void {
  useEffect(() => {
    const click = (event: MouseEvent) => {
      if (!ask(open, event.target, { x: event.clientX, y: event.clientY })) return;
      event.preventDefault();
      event.stopPropagation();
    };
    window.addEventListener("contextmenu", click, { capture: true });
    return () => window.removeEventListener("contextmenu", click, { capture: true });
  }, [open]);
}
