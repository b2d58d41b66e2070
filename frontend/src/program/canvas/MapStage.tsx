/** The map with a program on it: floor, lines, machines, chips, robots. What a press means is the caller's. */
import { ReactFlowProvider, useReactFlow } from "@xyflow/react";
import "@xyflow/react/dist/style.css";
import { type PointerEvent, useCallback, useEffect, useMemo, useRef, useState, useSyncExternalStore } from "react";
import { formatNumber, withUnit } from "@/i18n/format";
import { type FloorPlan, knownBox } from "@/map/floor/floor";
import { isRobot } from "@/map/devices/device";
import { FloorCanvas } from "@/map/floor/FloorCanvas";
import { type Box, fitViewport, PIXELS_PER_METRE, type Viewport } from "@/map/plane/projection";
import { useSize } from "@/map/plane/useSize";
import { ViewportCell } from "@/map/plane/viewport";
import { RobotLayer, RobotPaths } from "@/map/robots/RobotLayer";
import type { PaintedLooks } from "../painting/looks";
import { detailAt } from "../scene/detail";
import { overlaps } from "../scene/geometry";
import { type Pieces, piecesOf, splitOver } from "../scene/pieces";
import { deviceBox } from "../surroundings";
import { buildNodes, keepUnchanged, placeLabels } from "./buildNodes";
import { ConstructCanvas } from "./ConstructCanvas";
import { Drawing } from "./Drawing";
import { useFingerCount } from "../touch/fingers";
import type { StageNode } from "./nodes";
import { deviceUnder, StageFlow, usePress, useBoxDirection } from "./StageFlow";
import { type Guide, useSnapping } from "./snapping";
import classes from "./stage.module.css";
import { StageContext, type StageHandle } from "./stageContext";
import type { MapStageProps } from "./stageProps";
import { useMovingNodes, withCarried } from "./useMovingNodes";
import { useNear } from "./useNear";
import { usePointed } from "./usePointed";

export type { MapStageProps, StagePress } from "./stageProps";

export function MapStage(props: MapStageProps) {
  return (
    <ReactFlowProvider>
      <Stage {...props} />
    </ReactFlowProvider>
  );
}

function Stage(props: MapStageProps) {
  const { plan, devices, scene, looks, robots, lines } = props;
  const [element, size] = useSize<HTMLDivElement>();
  const [viewport] = useState(() => new ViewportCell());
  const pieces = useMemo(() => piecesOf(scene), [scene]);
  const pointing = usePointed(pieces, !props.onlyFloor);
  const { pointed } = pointing;
  const chosenLink = lines?.chosenLink;
  const { selected } = looks;
  const near = useNear({ pieces, viewport, size, pointed, selected, carried: props.carried, chosenLink });
  const painted = usePaintedLooks(props);
  const isTaken = useTaken(pieces);
  const { below, over } = useMemo(() => splitOver(pieces, machineBoxes(devices)), [pieces, devices]);
  const count = useMemo(
    () => pieces.chips.items.filter(({ id }) => !near.without.has(id)).length,
    [pieces, near.without],
  );
  const snapping = useSnapping(scene, devices, viewport);
  const shown = useStageNodes(props, viewport, near.mounted);
  const box = useBoxDirection();
  const moving = useMovingNodes(shown, props, snapping.snapTo);
  const handle = useHandle(props, size, viewport);
  const watch = (event: PointerEvent) => {
    snapping.watch(event);
    box.watch(event);
    pointing.onMove(event);
  };
  return (
    <div
      ref={element}
      className={classes.stage}
      data-tool={props.mode}
      data-only-floor={props.onlyFloor || undefined}
      data-map
      tabIndex={-1}
      role="application"
      aria-label={props.label}
      onPointerMoveCapture={watch}
      onPointerLeave={pointing.onLeave}
      onFocus={pointing.onFocus}
      onBlur={pointing.onBlur}
      {...usePointing(props)}
    >
      <FloorCanvas plan={plan} viewport={viewport} />
      {robots ? <RobotPaths source={robots} viewport={viewport} trails={props.trails} /> : null}
      <ConstructCanvas viewport={viewport} pieces={below} looks={painted} count={count} {...near} />
      <StageFlow {...props} moving={moving} box={box} viewport={viewport} pieces={pieces}>
        {props.under}
        <Lines {...props} pieces={pieces} mounted={near.mounted} />
        {props.plane}
        <Guides guides={moving.guides} />
      </StageFlow>
      <ConstructCanvas viewport={viewport} pieces={over} looks={painted} without={near.without} />
      {robots ? <RobotLayer source={robots} viewport={viewport} isTaken={isTaken} /> : null}
      <StageContext value={handle}>{props.children}</StageContext>
    </div>
  );
}

function machineBoxes(devices: MapStageProps["devices"]): Box[] {
  return devices.filter((device) => !isRobot(device)).map(deviceBox);
}

/** The nodes of machines, the start and those constructs that are elements, as others hold them. */
function useStageNodes(props: MapStageProps, viewport: ViewportCell, mounted: ReadonlySet<string>): StageNode[] {
  const { plan, devices, scene, looks, carried } = props;
  const detail = useSyncExternalStore(
    useCallback((listener) => viewport.subscribe(listener), [viewport]),
    () => detailAt(viewport.get().zoom),
  );
  const labels = useMemo(() => placeLabels(scene, devices, plan), [scene, devices, plan]);
  const last = useRef<StageNode[]>([]);
  return useMemo(() => {
    const built = buildNodes(scene, devices, labels, looks, { mounted, detail });
    last.current = keepUnchanged(last.current, withCarried(built, carried));
    return last.current;
  }, [scene, devices, labels, looks, mounted, detail, carried]);
}

function usePaintedLooks({ looks, lines }: MapStageProps): PaintedLooks {
  const { selected, stateOf, othersOn } = looks;
  const { chosenLink, targetWords } = lines ?? {};
  return useMemo(
    () => ({ selected, stateOf, othersOn, chosenLink, targetWords }),
    [selected, stateOf, othersOn, chosenLink, targetWords],
  );
}

/** Tells where a robot's name would stand on a construct. */
function useTaken({ chips }: Pieces): (box: Box) => boolean {
  return useCallback((box) => chips.within(box).some(({ chip }) => overlaps(chip.box, box)), [chips]);
}

function Lines({
  pieces,
  mounted,
  looks,
  onStep,
  lines,
}: MapStageProps & { pieces: Pieces; mounted: ReadonlySet<string> }) {
  const shown = useMemo(() => pieces.lines.items.filter(({ id }) => mounted.has(id)), [pieces, mounted]);
  return <Drawing lines={shown} selected={looks.selected} stateOf={looks.stateOf} onSelectStep={onStep} {...lines} />;
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
  useFirstFit(fit, plan && size.width > 0 ? plan : null, `${size.width} ${size.height} ${insets.bottom}`, viewport);
  return useMemo<StageHandle>(
    () => ({ viewport, pane: size, fit: () => void fit(true), flow }),
    [viewport, size, fit, flow],
  );
}

/**
 * The map is brought into the free area when it is first there, and again when the `area` is another one: the window is
 * resized, or what stands below opens or closes. Once people have moved it, it stays where they put it.
 */
export function useFirstFit(
  fit: (animate: boolean) => Viewport | null,
  plan: FloorPlan | null,
  area: string,
  viewport: StageHandle["viewport"],
): void {
  const last = useRef<{ plan: FloorPlan; area: string; view: Viewport | null } | null>(null);
  useEffect(() => {
    const before = last.current;
    if (!plan || (before?.plan === plan && before.area === area)) return;
    const moved = before?.plan === plan && !isSameView(before.view, viewport.get());
    last.current = { plan, area, view: moved ? null : fit(false) };
  }, [fit, plan, area, viewport]);
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
            {withUnit(formatNumber(Math.hypot(to.x - from.x, to.y - from.y) / PIXELS_PER_METRE, 1), "m")}
          </text>
        </g>
      ))}
    </svg>
  );
}
