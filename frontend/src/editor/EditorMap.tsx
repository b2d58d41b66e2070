/** The map of the editor: what presses, drags and keys on it mean for the program. */
import { Suspense, useCallback, useMemo } from "react";
import { beside } from "@/design/useFetchLater";
import { liveRobots } from "@/live/robots";
import { isRobot } from "@/map/devices/device";
import { type Insets, toMetres, toPixels } from "@/map/plane/projection";
import type { NodeLooks } from "@/program/canvas/buildNodes";
import { MapControls } from "@/program/canvas/MapControls";
import { MapStage, type MapStageProps, type StagePress } from "@/program/canvas/MapStage";
import type { Light } from "@/program/canvas/MachineNode";
import { chipLabel } from "@/program/scene/announcements";
import { frameAt } from "@/program/scene/frames";
import type { SiteDevice } from "@/program/surroundings";
import { useOpenProgram, type OpenProgram } from "./state/context";
import { chooseBranch, invitation } from "./state/nextPlace";
import { goInto, goIntoAt } from "./state/newStep";
import { useDrawing, type Drawing } from "./canvas/stepGesture";
import { moveChips } from "./canvas/chipDrop";
import { cursorShower, dragShower, othersOn, useCarried } from "./state/presence";
import { asksForDevice, askOf, stepBack, suits, type Gesture } from "./state/tool";
import { robotAt } from "./state/under";
import { select, showDevice, toggleSelected, useUi } from "./state/ui";
import { swapBranches } from "./edits/branches";
import { Ghosts } from "./gestures/Ghosts";
import { ModeInView, ModeMark } from "./keyboard/ModeBar";
import { KeepInView } from "./canvas/KeepInView";
import { joinByDot } from "./gestures/connection";
import { JoinLine } from "./gestures/JoinLine";
import { RouteBends } from "./gestures/RouteBends";
import { StageAtHand } from "./gestures/StageAtHand";
import { settle } from "./state/actions";
import { useGestures } from "./state/gestures";
import { DevicePalette } from "./canvas/DevicePalette";
import { LanePreview } from "./canvas/LanePreview";
import { LoadAsk } from "./canvas/LoadAsk";
import { PreviewLine } from "./canvas/PreviewLine";
import { ZONE_TOOL } from "./state/tools";
import { pressZoneTool } from "./zones/zoneTool";
import { EditorZones, ZoneHandles } from "./zones/ZoneLayer";

const FollowView = beside(async () => (await import("./gestures/FollowView")).FollowView);
const Cursors = beside(async () => (await import("./canvas/Cursors")).Cursors);
const CommentPins = beside(async () => (await import("./comments/CommentPins")).CommentPins);
const CoverageMarks = beside(async () => (await import("./tests/CoverageMarks")).CoverageMarks);

interface EditorMapProps {
  insets: Insets;
  fitInsets: Insets;
  small: boolean;
}

export function EditorMap({ insets, fitInsets, small }: EditorMapProps) {
  const open = useOpenProgram();
  const { plan, devices, scene, shared, t } = open;
  const gesture = useUi((ui) => ui.gesture);
  const drawing = useDrawing(open, gesture);
  const showCursor = useMemo(() => cursorShower(shared), [shared]);
  const presses = usePresses(open, gesture, drawing);
  return (
    <MapStage
      plan={plan}
      devices={devices}
      scene={scene}
      looks={useLooks(gesture)}
      robots={liveRobots}
      insets={fitInsets}
      label={t("map_label")}
      mode={gesture.tool === "pan" ? "pan" : gesture.tool === "select" ? "select" : "draw"}
      lines={useLines(open, drawing.takeFloor)}
      onlyFloor={gesture.tool === ZONE_TOOL}
      {...presses}
      carried={useCarried(shared)}
      onDragging={useMemo(() => dragShower(shared), [shared])}
      onMove={(moved) => moveChips(open, moved)}
      onSelectMany={select}
      joinLine={JoinLine}
      onJoin={(from, to, at) => joinByDot(open, from, to, at)}
      onOwnPan={() => useGestures.setState({ following: null })}
      onPointer={(at) => {
        showCursor(at);
        drawing.pointer.set({ ...toPixels(at), zoom: 1 });
      }}
      under={
        <>
          <EditorZones />
          <LanePreview />
        </>
      }
      plane={<Plane drawing={drawing} />}
    >
      <Suspense fallback={null}>
        <FollowView />
      </Suspense>
      <StageAtHand />
      {small ? <KeepInView /> : null}
      <ModeInView />
      <Ghosts />
      <Suspense fallback={null}>
        <Cursors shared={shared} />
      </Suspense>
      <DevicePalette onChoose={presses.onDevice} />
      {drawing.askAt ? <LoadAsk at={drawing.askAt} loads={drawing.loads} onChoose={drawing.takeLoad} /> : null}
      <MapControls plan={plan} scene={scene} insets={insets} mini />
    </MapStage>
  );
}

/** What lies in the map's plane over the drawing. */
function Plane({ drawing }: { drawing: Drawing }) {
  const tested = useUi((ui) => ui.drawer.open && ui.drawer.tab === "tests");
  return (
    <>
      <PreviewLine from={drawing.from} route={drawing.preview} pointer={drawing.pointer} />
      <RouteBends />
      <ModeMark />
      <Suspense fallback={null}>
        <CommentPins />
      </Suspense>
      {tested ? (
        <Suspense fallback={null}>
          <CoverageMarks />
        </Suspense>
      ) : null}
      <ZoneHandles pointer={drawing.pointer} />
    </>
  );
}

/** What presses on steps, machines and the floor mean with the tool in hand. */
function usePresses(open: OpenProgram, gesture: Gesture, drawing: Drawing) {
  const onStep = useCallback(
    (step: string, add: boolean) => {
      // A frame's head says where the next step goes, as its inside does.
      const frame = asksForDevice(useUi.getState().gesture) && open.scene.frames.find(({ id }) => id === step);
      if (frame) goInto(open, frame);
      else if (add) toggleSelected(step);
      else select([step]);
    },
    [open],
  );
  const onBack = () => useUi.setState({ gesture: stepBack(gesture), fieldPick: null });
  const onDevice = (device: string) => {
    const { fieldPick } = useUi.getState();
    if (fieldPick) {
      fieldPick.choose(device);
      useUi.setState({ fieldPick: null });
    } else if (askOf(gesture) === "nothing") showDevice(device);
    // The source's own press ends here too: it began on the way down, so that it can be dragged from.
    else if (device !== gesture.source) drawing.takeDevice(device);
  };
  const onFloor = (press: StagePress) => {
    const ask = askOf(gesture);
    if (gesture.tool === ZONE_TOOL) {
      pressZoneTool(open, press.at);
      return;
    }
    useGestures.setState({ zone: null });
    if (ask === "floor" || ask === "goal") drawing.takeFloor(press.at);
    else if (ask === "nothing") pressResting(open, press);
    else if (!asksForDevice(gesture) || !goIntoAt(open, press.at)) onBack();
  };
  const onEditStep = (step: string) => {
    select([step]);
    toggleHull(open.document.steps[step]?.params.function);
  };
  return { onStep, onBack, onDevice, onFloor, onEditStep, onDeviceDown: drawing.dragFrom, onDeviceUp: drawing.dragTo };
}

/** A press on the floor with an empty hand chooses the frame there, or nothing. */
function pressResting(open: OpenProgram, press: StagePress): void {
  const robot = robotAt(press.at);
  if (robot !== null) {
    showDevice(robot);
    return;
  }
  const frame = frameAt(open.scene.frames, toPixels(press.at));
  select(frame ? [frame.id] : []);
  if (frame && open.canEdit) goInto(open, frame);
}

/** What presses on arrows and their words do. */
function useLines(open: OpenProgram, takeFloor: Drawing["takeFloor"]): MapStageProps["lines"] {
  const { document, canEdit, t } = open;
  const into = useUi((ui) => ui.into);
  return {
    chosenLink: into?.link ?? null,
    onSwap: canEdit ? (step) => settle(open, swapBranches(document, step)) : undefined,
    swapLabel: t("gesture.swap"),
    targetWords: canEdit ? (into) => invitation(open, into) : undefined,
    onSelectLink: canEdit
      ? (link) => {
          const end = link.points.at(-1);
          chooseBranch(open, link);
          if (link.to === null && end && askOf(useUi.getState().gesture) === "floor") takeFloor(toMetres(end));
        }
      : undefined,
  };
}

/** A call opened or closed: its function's body shown on the map or not. */
function toggleHull(functionId: unknown): void {
  if (typeof functionId !== "string") return;
  useUi.setState(({ collapsed }) => {
    const next = new Set(collapsed);
    if (!next.delete(functionId)) next.add(functionId);
    return { collapsed: next };
  });
}

function useLooks(gesture: Gesture): NodeLooks {
  const { people, t, speaker, surroundings, canEdit } = useOpenProgram();
  const selected = useUi((ui) => ui.selected);
  const fresh = useUi((ui) => ui.fresh);
  const fieldPick = useUi((ui) => ui.fieldPick);
  return useMemo<NodeLooks>(() => {
    const source = gesture.source ? surroundings.devices.get(gesture.source) : undefined;
    return {
      selected: new Set(selected),
      stateOf: () => null,
      othersOn: othersOn(people),
      lightOf: (device) => lightOf(device, gesture, source, fieldPick !== null),
      captionOf: (device) => captionOf(device, gesture, t),
      noteOf: (chip) => (chip.movesAdded && chip.id === fresh ? t("move_added") : null),
      labelOf: (chip) => chipLabel(chip, speaker),
      startLabel: t("start"),
      editable: canEdit && gesture.tool !== "pan",
    };
  }, [selected, fresh, fieldPick, people, gesture, t, speaker, surroundings, canEdit]);
}

function lightOf(device: SiteDevice, gesture: Gesture, source: SiteDevice | undefined, anyMachine: boolean): Light {
  if (device.id === gesture.source || device.id === gesture.target) return "chosen";
  if (anyMachine) return isRobot(device) ? null : "suitable";
  if (!asksForDevice(gesture)) return null;
  return suits(gesture, device, source) ? "suitable" : "dim";
}

function captionOf(device: SiteDevice, gesture: Gesture, t: (key: string) => string): string | null {
  if (gesture.tool === "select") return null;
  if (device.id === gesture.source) return t("caption.source");
  return device.id === gesture.target ? t("caption.target") : null;
}
