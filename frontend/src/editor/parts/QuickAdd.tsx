/** The short list at a point of the map: what the device there can do first, then all constructs, found by typing. */
import { lazy, Suspense, useEffect } from "react";
import { useOpenProgram } from "../state/context";
import { underPointer } from "../state/under";
import { useUi } from "../state/ui";

export const loadQuickList = () => import("./QuickList");
const QuickList = lazy(async () => ({ default: (await loadQuickList()).QuickList }));

export function QuickAdd() {
  const open = useOpenProgram();
  const quick = useUi((ui) => ui.quick);
  useDoubleClick(open.canEdit);
  if (!quick || !open.canEdit) return null;
  return (
    <Suspense fallback={null}>
      <QuickList key={`${quick.x} ${quick.y}`} where={quick} />
    </Suspense>
  );
}

/** Twice on the bare floor, or on a machine. On a step it opens the step. */
function useDoubleClick(canEdit: boolean): void {
  const open = useOpenProgram();
  useEffect(() => {
    const ask = (event: MouseEvent) => {
      const { gesture, dialog } = useUi.getState();
      const onMap = event.target instanceof Element && event.target.closest(".react-flow__pane, .react-flow__node");
      if (!canEdit || !onMap || dialog || gesture.tool !== "select") return;
      const under = underPointer(open, { x: event.clientX, y: event.clientY });
      if (!under || under.step !== null || under.link) return;
      const { at, device } = under;
      useUi.setState({ quick: { x: event.clientX, y: event.clientY, at, device }, device: null });
    };
    window.addEventListener("dblclick", ask);
    return () => window.removeEventListener("dblclick", ask);
  }, [open, canEdit]);
}
