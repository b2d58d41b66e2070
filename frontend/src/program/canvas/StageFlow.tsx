/** The part of the stage that zooms, pans, selects and drags: React Flow, told what its events mean here. */
import {
  ConnectionMode,
  type Node,
  type OnConnectEnd,
  ReactFlow,
  SelectionMode,
  useReactFlow,
  ViewportPortal,
} from "@xyflow/react";
import { type MouseEvent, type PointerEvent, type ReactNode, useCallback, useRef, useState } from "react";
import { joinTarget, pointOf } from "./snapping";
import { type FloorPlan, leastZoom, planBox } from "@/map/floor/floor";
import { boxAround, toMetres, toPixels } from "@/map/plane/projection";
import type { ViewportCell } from "@/map/plane/viewport";
import { chipAt, chipsIn, lineAt, type Pieces } from "../scene/pieces";
import { DEVICE_PREFIX, START_ID } from "./buildNodes";
import { nodeTypes, type StageNode } from "./nodes";
import { useFingers } from "../touch/fingers";
import type { MapStageProps, StagePress } from "./stageProps";
import type { MovingNodes } from "./useMovingNodes";
import { LINE_REACH } from "./usePointed";

interface StageFlowProps extends MapStageProps {
  moving: MovingNodes;
  box: ReturnType<typeof useBoxDirection>;
  viewport: ViewportCell;
  pieces: Pieces;
  children: ReactNode;
}

const NO_EDGES: never[] = [];

/** Reads a press as a place on the floor. */
export function usePress() {
  const flow = useReactFlow();
  return (event: MouseEvent | PointerEvent): StagePress => ({
    at: toMetres(flow.screenToFlowPosition({ x: event.clientX, y: event.clientY })),
    add: event.shiftKey,
  });
}

export function StageFlow(props: StageFlowProps) {
  const { moving, box, viewport, mode, looks } = props;
  const flow = useReactFlow();
  // One finger pans and two zoom; a mouse boxes, and pans with its wheel.
  const touching = useFingers((fingers) => fingers.touching);
  return (
    <ReactFlow<StageNode>
      nodes={moving.nodes}
      edges={NO_EDGES}
      nodeTypes={nodeTypes}
      onNodesChange={moving.onNodesChange}
      onNodeDragStop={moving.onDragStop}
      {...usePresses(props)}
      {...useSelecting(props)}
      onConnectEnd={useJoining(props)}
      connectionLineComponent={props.joinLine}
      connectionMode={ConnectionMode.Loose}
      connectionRadius={0}
      onInit={() => viewport.set(flow.getViewport())}
      onMove={(event, view) => {
        if (event) props.onOwnPan?.();
        viewport.set(view);
      }}
      selectionMode={box.mode}
      panOnDrag={mode === "pan" || !looks.editable || touching ? true : [1]}
      panActivationKeyCode="Space"
      deleteKeyCode={null}
      disableKeyboardA11y
      nodesDraggable={looks.editable && mode !== "draw"}
      nodesConnectable={looks.editable}
      zoomOnDoubleClick={false}
      minZoom={leastZoom(props.plan)}
      maxZoom={3}
      onlyRenderVisibleElements
      nodeDragThreshold={3}
      translateExtent={props.plan ? extentOf(props.plan) : undefined}
      proOptions={{ hideAttribution: true }}
    >
      <ViewportPortal>{props.children}</ViewportPortal>
    </ReactFlow>
  );
}

function usePresses(props: StageFlowProps) {
  const press = usePress();
  return {
    onNodeClick: (event: MouseEvent, node: StageNode) => clickNode(props, node, press(event)),
    onNodeDoubleClick: (_event: MouseEvent, node: StageNode) => {
      if (node.type === "step") props.onEditStep?.(node.id);
    },
    onPaneClick: (event: MouseEvent) => clickPainted(props, press(event)),
    onPaneContextMenu: (event: MouseEvent | globalThis.MouseEvent) => {
      event.preventDefault();
      props.onBack?.();
    },
  };
}

/** What is drawn round is found among all constructs, whether they have nodes or not. */
function useSelecting({ moving, box, mode, looks, pieces, onSelectMany }: StageFlowProps) {
  const touching = useFingers((fingers) => fingers.touching);
  const flow = useReactFlow();
  return {
    onSelectionDragStop: moving.onSelectionDragStop,
    onSelectionStart: box.begin,
    onSelectionEnd: () => {
      const drawn = box.end();
      if (!drawn) return;
      const [from, to] = [drawn.from, drawn.to].map((at) => flow.screenToFlowPosition(at, { snapToGrid: false }));
      const around = from && to && boxAround([from, to]);
      const chosen = around ? chipsIn(pieces, around, drawn.touching) : [];
      if (chosen.length > 0) onSelectMany?.(chosen);
    },
    selectionOnDrag: mode === "select" && looks.editable && !touching,
    selectionKeyCode: null,
    multiSelectionKeyCode: "Shift",
  };
}

function useJoining({ scene, viewport, onJoin }: StageFlowProps): OnConnectEnd {
  const flow = useReactFlow();
  return (event, state) => {
    const at = pointOf(event);
    const from = state.fromNode?.id;
    // A pinch leaves no arrow that one of its fingers happened to begin.
    if (from === undefined || !at || useFingers.getState().several) return;
    const to = joinTarget(scene.chips, from, flow.screenToFlowPosition(at), viewport.get().zoom);
    if (to !== null) onJoin?.(from, to, at);
  };
}

/** A finger has pressed what is only painted: it is pressed as its element would be. */
function clickPainted(props: StageFlowProps, { at, add }: StagePress): void {
  const point = toPixels(at);
  const chip = props.onlyFloor ? null : chipAt(props.pieces, point);
  const line = props.onlyFloor || chip ? null : lineAt(props.pieces, point, LINE_REACH / props.viewport.get().zoom);
  const step = chip?.id ?? (line && "route" in line ? line.route.steps[0]?.step : undefined);
  if (step !== undefined) props.onStep?.(step, add);
  else if (line && "link" in line && props.lines?.onSelectLink) props.lines.onSelectLink(line.link);
  else props.onFloor?.({ at, add });
}

function extentOf(plan: FloorPlan): [[number, number], [number, number]] {
  const box = planBox(plan);
  const margin = 1200;
  return [
    [box.left - margin, box.top - margin],
    [box.right + margin, box.bottom + margin],
  ];
}

export function clickNode(props: MapStageProps, node: Node, press: StagePress): void {
  if (node.id.startsWith(DEVICE_PREFIX)) props.onDevice?.(node.id.slice(DEVICE_PREFIX.length), press);
  else if (node.id !== START_ID) props.onStep?.(node.id, press.add);
}

/** The machine whose node an event happened on. */
export function deviceUnder(event: PointerEvent): string | null {
  const under = document.elementFromPoint(event.clientX, event.clientY);
  const id = under?.closest(".react-flow__node")?.getAttribute("data-id");
  return id?.startsWith(DEVICE_PREFIX) ? id.slice(DEVICE_PREFIX.length) : null;
}

interface DrawnBox {
  /** Pixels of the window. */
  readonly from: { readonly x: number; readonly y: number };
  readonly to: { readonly x: number; readonly y: number };
  /** Drawn to the left: what it touches, not only what lies in it. */
  readonly touching: boolean;
}

export function useBoxDirection() {
  const [touching, setTouching] = useState(false);
  const drawn = useRef<DrawnBox | null>(null);
  const begin = useCallback(({ clientX: x, clientY: y }: { clientX: number; clientY: number }) => {
    drawn.current = { from: { x, y }, to: { x, y }, touching: false };
  }, []);
  const watch = useCallback(({ clientX: x, clientY: y, buttons }: PointerEvent) => {
    const before = drawn.current;
    if (!before || buttons === 0) return;
    drawn.current = { ...before, to: { x, y }, touching: x < before.from.x };
    setTouching(x < before.from.x);
  }, []);
  const end = useCallback(() => {
    const box = drawn.current;
    drawn.current = null;
    setTouching(false);
    return box;
  }, []);
  return { mode: touching ? SelectionMode.Partial : SelectionMode.Full, begin, watch, end };
}
