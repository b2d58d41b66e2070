/** The map's viewport for what floats over it: minimap, zoom buttons, cursors. */
import type { ReactFlowInstance } from "@xyflow/react";
import { createContext, use } from "react";
import type { ViewportCell } from "@/map/plane/viewport";

export interface StageHandle {
  readonly viewport: ViewportCell;
  readonly pane: { readonly width: number; readonly height: number };
  readonly fit: () => void;
  readonly flow: Pick<
    ReactFlowInstance,
    "zoomIn" | "zoomOut" | "zoomTo" | "setCenter" | "getZoom" | "screenToFlowPosition" | "flowToScreenPosition"
  >;
}

export const StageContext = createContext<StageHandle | null>(null);

export function useStage(): StageHandle {
  const stage = use(StageContext);
  if (!stage) throw new Error("This part belongs inside a MapStage.");
  return stage;
}
