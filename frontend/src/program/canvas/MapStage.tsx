/** The map with a program on it: floor, lines, machines, chips, robots. What a press means is the caller's. */
import { ReactFlowProvider, useReactFlow } from "@xyflow/react";
import "@xyflow/react/dist/style.css";
import { type PointerEvent, useCallback, useEffect, useMemo, useRef, useState } from "react";
import { type FloorPlan, knownBox } from "@/map/floor/floor";
import { FloorCanvas } from "@/map/floor/FloorCanvas";
import { fitViewport, PIXELS_PER_METRE, type Viewport } from "@/map/plane/projection";
import { useSize } from "@/map/plane/useSize";
import { ViewportCell } from "@/map/plane/viewport";
import { RobotLayer, RobotPaths } from "@/map/robots/RobotLayer";
import { buildNodes } from "./buildNodes";
import { Drawing } from "./Drawing";
import { deviceUnder, type LevelOfDetail, StageFlow, usePress, useBoxDirection } from "./StageFlow";
import { useFingerCount } from "../touch/fingers";
import { type Guide, useSnapping } from "./snapping";
import classes from "./stage.module.css";
import { StageContext, type StageHandle } from "./stageContext";
import type { MapStageProps } from "./stageProps";
import { useMovingNodes, withCarried } from "./useMovingNodes";

export type { MapStageProps, StagePress } from "./stageProps";

export function MapStage(props: MapStageProps) {
  return (
    <ReactFlowProvider>
      <Stage {...props} />
    </ReactFlowProvider>
  );
}

function Stage(props: MapStageProps) {
  const { plan, devices, scene, looks, robots } = props;
  const [element, size] = useSize<HTMLDivElement>();
  const [viewport] = useState(() => new ViewportCell());
  const [level, setLevel] = useState<LevelOfDetail>("full");
  const built = useMemo(() => buildNodes(scene, devices, looks, plan), [scene, devices, looks, plan]);
  const snapping = useSnapping(scene, devices, viewport);
  const shown = useMemo(() => withCarried(built, props.carried), [built, props.carried]);
  const moving = useMovingNodes(shown, props, snapping.snapTo);
  const box = useBoxDirection();
  const handle = useHandle(props, size, viewport);
  const taken = useMemo(() => [...scene.chips.values()].map((chip) => chip.box), [scene]);
  const watch = (event: PointerEvent) => {
    snapping.watch(event);
    box.watch(event);
  };
  return (
    <div
      ref={element}
      className={classes.stage}
      data-lod={level}
      data-tool={props.mode}
      data-only-floor={props.onlyFloor || undefined}
      data-map
      tabIndex={-1}
      role="application"
      aria-label={props.label}
      onPointerMoveCapture={watch}
      {...usePointing(props)}
    >
      <FloorCanvas plan={plan} viewport={viewport} />
      {robots ? <RobotPaths source={robots} viewport={viewport} trails={props.trails} /> : null}
      <StageFlow {...props} moving={moving} box={box} viewport={viewport} onLevel={setLevel}>
        {props.under}
        <Lines {...props} />
        {props.plane}
        <Guides guides={moving.guides} />
      </StageFlow>
      {robots ? <RobotLayer source={robots} viewport={viewport} taken={taken} /> : null}
      <StageContext value={handle}>{props.children}</StageContext>
    </div>
  );
}

function Lines({ scene, looks, onStep, lines }: MapStageProps) {
  return (
    <Drawing
      scene={scene}
      selected={looks.selected}
      stateOf={looks.stateOf}
      othersOn={looks.othersOn}
      onSelectStep={onStep}
      {...lines}
    />
  );
}

/** The pointer over the floor and on machines, from the way down to the way up. */
function usePointing({ onPointer, onDeviceDown, onDeviceUp }: MapStageProps) {
  const press = usePress();
  useFingerCount();
  return {
    onPointerMove: onPointer ? (event: PointerEvent) => onPointer(press(event).at) : undefined,
    onPointerUp: (event: PointerEvent) => {
      const device = event.pointerType === "touch" ? null : deviceUnder(event);
      if (device) onDeviceUp?.(device);
    },
    onPointerDown: (event: PointerEvent) => {
      // A finger that presses here may be about to pan or pinch: what it means is known when it is lifted, by its tap.
      const device = event.pointerType === "touch" ? null : deviceUnder(event);
      if (device && event.button === 0) onDeviceDown?.(device);
    },
  };
}

/** What floats over the map may do with its view; the map is fitted when it is first there. */
function useHandle(
  { plan, insets }: MapStageProps,
  size: { width: number; height: number },
  viewport: ViewportCell,
): StageHandle {
  const flow = useReactFlow();
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
  return useMemo<StageHandle>(
    () => ({ viewport, pane: size, fit: () => void fit(true), flow }),
    [viewport, size, fit, flow],
  );
}

/**
 * The map is brought into the free area when it is first there, and again when what stands below it opens or closes;
 * once people have moved it, it stays where they put it.
 */
export function useFirstFit(
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

export function Guides({ guides }: { guides: readonly Guide[] }) {
  if (guides.length === 0) return null;
  return (
    <svg className={classes.drawing} width={1} height={1} aria-hidden="true">
      {guides.map(({ from, to }, index) => (
        <g key={index} className={classes.guide}>
          <line x1={from.x} y1={from.y} x2={to.x} y2={to.y} />
          <text x={(from.x + to.x) / 2 + 5} y={(from.y + to.y) / 2 - 5}>
            {`${(Math.hypot(to.x - from.x, to.y - from.y) / PIXELS_PER_METRE).toFixed(1)}\u202fm`}
          </text>
        </g>
      ))}
    </svg>
  );
}
