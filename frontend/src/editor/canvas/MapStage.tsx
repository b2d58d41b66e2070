/** The map with a program on it: floor, lines, machines, chips, robots. What a press means is the caller's. */
import {
  ConnectionMode,
  ReactFlow,
  ReactFlowProvider,
  useReactFlow,
  ViewportPortal,
  type Node,
  type OnConnectEnd,
} from "@xyflow/react";
import "@xyflow/react/dist/style.css";
import {
  useCallback,
  useEffect,
  useMemo,
  useRef,
  useState,
  type ReactNode,
  type MouseEvent,
  type PointerEvent,
} from "react";
import { FloorCanvas } from "@/map/FloorCanvas";
import { planBox, type FloorPlan } from "@/map/floor";
import { knownBox } from "@/map/floor";
import { fitViewport, toMetres, type Insets, type Point, type Viewport } from "@/map/projection";
import { RobotLayer } from "@/map/RobotLayer";
import type { RobotSource } from "@/map/robots";
import { ViewportCell } from "@/map/viewport";
import { useSize } from "@/map/useSize";
import type { SiteDevice } from "../scene/surroundings";
import type { Scene } from "../scene/scene";
import { buildNodes, DEVICE_PREFIX, START_ID, type NodeLooks } from "./buildNodes";
import { Drawing, type DrawingProps } from "./Drawing";
import { Guides } from "../gestures/Guides";
import { joinTarget, pointOf } from "../gestures/joining";
import { useSnapping } from "../gestures/useSnapping";
import { JoinLine } from "./JoinLine";
import { nodeTypes, type StageNode } from "./nodes";
import classes from "./stage.module.css";
import { StageContext, type StageHandle } from "./stageContext";
import { useBoxDirection } from "./useBoxDirection";
import { useMovingNodes, type MovedNode } from "./useMovingNodes";

export interface StagePress {
  readonly at: Point;
  readonly add: boolean;
}

export interface MapStageProps {
  plan: FloorPlan | null;
  devices: readonly SiteDevice[];
  scene: Scene;
  looks: NodeLooks;
  robots?: RobotSource;
  trails?: boolean;
  insets: Insets;
  label: string;
  mode: "select" | "pan" | "draw";
  /** Presses go through steps, lines and machines to the floor. */
  onlyFloor?: boolean;
  lines?: Pick<DrawingProps, "onSelectLink" | "chosenLink" | "onSwap" | "swapLabel">;
  onStep?: (step: string, add: boolean) => void;
  onEditStep?: (step: string) => void;
  onDevice?: (device: string, press: StagePress) => void;
  onDeviceDown?: (device: string) => void;
  onDeviceUp?: (device: string) => void;
  onFloor?: (press: StagePress) => void;
  onBack?: () => void;
  onMove?: (moved: readonly MovedNode[]) => void;
  onMoveStart?: (at: Point) => void;
  onSelectMany?: (steps: readonly string[]) => void;
  /** A dot let go over a step; `at` in pixels of the window. */
  onJoin?: (from: string, to: string, at: { x: number; y: number }) => void;
  /** This person moved the map, as against the program. */
  onOwnPan?: () => void;
  onPointer?: (at: Point) => void;
  /** In the map's plane (drawing pixels), under all that is drawn. */
  under?: ReactNode;
  /** More in the map's plane. */
  plane?: ReactNode;
  /** More over the map, not moving with it. */
  children?: ReactNode;
}

export function MapStage(props: MapStageProps) {
  return (
    <ReactFlowProvider>
      <Stage {...props} />
    </ReactFlowProvider>
  );
}

function Stage(props: MapStageProps) {
  const { plan, devices, scene, looks, mode, insets } = props;
  const flow = useReactFlow();
  const [element, size] = useSize<HTMLDivElement>();
  const [viewport] = useState(() => new ViewportCell());
  const [lod, setLod] = useState<"full" | "icon" | "dot">("full");
  const built = useMemo(() => buildNodes(scene, devices, looks, plan?.places), [scene, devices, looks, plan]);
  const snapping = useSnapping(scene, devices, viewport);
  const moving = useMovingNodes(built, props.onMove, props.onSelectMany, snapping.snapTo);
  const box = useBoxDirection();
  const fit = useCallback(
    (animate: boolean) => {
      if (!plan || size.width === 0) return null;
      const view = fitViewport(knownBox(plan), size.width, size.height, insets, 1.6);
      void flow.setViewport(view, { duration: animate ? 280 : 0 });
      return view;
    },
    [flow, plan, size.width, size.height, insets],
  );
  useFirstFit(fit, plan && size.width > 0 ? plan : null, insets.bottom, viewport);
  const handle = useMemo<StageHandle>(
    () => ({ viewport, pane: size, fit: () => void fit(true), flow }),
    [viewport, size, fit, flow],
  );
  const press = (event: MouseEvent | PointerEvent): StagePress => ({
    at: toMetres(flow.screenToFlowPosition({ x: event.clientX, y: event.clientY })),
    add: event.shiftKey,
  });
  const onJoinEnd: OnConnectEnd = (event, state) => {
    const at = pointOf(event);
    const from = state.fromNode?.id;
    if (from === undefined || !at) return;
    const to = joinTarget(scene.chips, from, flow.screenToFlowPosition(at), viewport.get().zoom);
    if (to !== null) props.onJoin?.(from, to, at);
  };
  return (
    <div
      ref={element}
      className={classes.stage}
      data-lod={lod}
      data-tool={mode}
      data-only-floor={props.onlyFloor || undefined}
      role="application"
      aria-label={props.label}
      onPointerMove={props.onPointer ? (event) => props.onPointer?.(press(event).at) : undefined}
      onPointerMoveCapture={(event) => {
        snapping.watch(event);
        box.watch(event);
      }}
      onPointerUp={(event) => {
        const device = deviceUnder(event);
        if (device) props.onDeviceUp?.(device);
      }}
      onPointerDown={(event) => {
        const device = deviceUnder(event);
        if (device && event.button === 0) props.onDeviceDown?.(device);
      }}
    >
      <FloorCanvas plan={plan} viewport={viewport} />
      <ReactFlow<StageNode>
        nodes={moving.nodes}
        edges={NO_EDGES}
        nodeTypes={nodeTypes}
        onNodesChange={moving.onNodesChange}
        onNodeDragStop={moving.onDragStop}
        onSelectionDragStop={moving.onSelectionDragStop}
        onSelectionStart={box.begin}
        onSelectionEnd={() => {
          box.end();
          moving.onSelectionEnd();
        }}
        onNodeClick={(event, node) => clickNode(props, node, press(event))}
        onNodeDoubleClick={(_event, node) => node.type === "step" && props.onEditStep?.(node.id)}
        onPaneClick={(event) => props.onFloor?.(press(event))}
        onPaneContextMenu={(event) => {
          event.preventDefault();
          props.onBack?.();
        }}
        onConnectEnd={onJoinEnd}
        connectionLineComponent={JoinLine}
        connectionMode={ConnectionMode.Loose}
        connectionRadius={0}
        onMove={(event, view) => {
          if (event) props.onOwnPan?.();
          viewport.set(view);
          setLod(view.zoom < 0.35 ? "dot" : view.zoom < 0.6 ? "icon" : "full");
        }}
        onInit={() => viewport.set(flow.getViewport())}
        selectionOnDrag={mode === "select" && looks.editable}
        selectionMode={box.mode}
        panOnDrag={mode === "pan" || !looks.editable ? true : [1]}
        panActivationKeyCode="Space"
        selectionKeyCode={null}
        multiSelectionKeyCode="Shift"
        deleteKeyCode={null}
        disableKeyboardA11y
        nodesDraggable={looks.editable && mode !== "draw"}
        nodesConnectable={looks.editable}
        zoomOnDoubleClick={false}
        minZoom={0.2}
        maxZoom={3}
        onlyRenderVisibleElements
        nodeDragThreshold={3}
        translateExtent={plan ? extentOf(plan) : undefined}
        proOptions={{ hideAttribution: true }}
      >
        <ViewportPortal>
          {props.under}
          <Drawing
            scene={scene}
            selected={looks.selected}
            stateOf={looks.stateOf}
            othersOn={looks.othersOn}
            onSelectStep={props.onStep}
            {...props.lines}
          />
          {props.plane}
          <Guides guides={moving.guides} />
        </ViewportPortal>
      </ReactFlow>
      {props.robots ? <RobotLayer source={props.robots} viewport={viewport} trails={props.trails ?? false} /> : null}
      <StageContext value={handle}>{props.children}</StageContext>
    </div>
  );
}

const NO_EDGES: never[] = [];

/**
 * The map is brought into the free area when it is first there, and again when what stands below it opens or closes;
 * once people have moved it, it stays where they put it.
 */
function useFirstFit(
  fit: (animate: boolean) => Viewport | null,
  plan: FloorPlan | null,
  bottom: number,
  viewport: StageHandle["viewport"],
): void {
  const last = useRef<{ plan: FloorPlan; bottom: number; view: Viewport | null } | null>(null);
  useEffect(() => {
    const before = last.current;
    if (!plan || (before?.plan === plan && before.bottom === bottom)) return;
    const moved = before?.plan === plan && !isSameView(before.view, viewport.get());
    last.current = { plan, bottom, view: moved ? null : fit(false) };
  }, [fit, plan, bottom, viewport]);
}

function isSameView(one: Viewport | null, other: Viewport): boolean {
  return one !== null && one.zoom === other.zoom && one.x === other.x && one.y === other.y;
}

function extentOf(plan: FloorPlan): [[number, number], [number, number]] {
  const box = planBox(plan);
  const margin = 1200;
  return [
    [box.left - margin, box.top - margin],
    [box.right + margin, box.bottom + margin],
  ];
}

function clickNode(props: MapStageProps, node: Node, press: StagePress): void {
  if (node.id.startsWith(DEVICE_PREFIX)) props.onDevice?.(node.id.slice(DEVICE_PREFIX.length), press);
  else if (node.id !== START_ID) props.onStep?.(node.id, press.add);
}

/** The machine whose node an event happened on. */
function deviceUnder(event: PointerEvent): string | null {
  const under = document.elementFromPoint(event.clientX, event.clientY);
  const id = under?.closest(".react-flow__node")?.getAttribute("data-id");
  return id?.startsWith(DEVICE_PREFIX) ? id.slice(DEVICE_PREFIX.length) : null;
}
