/** The zone tool: corner after corner, closed on the first one or with Enter. */
import { useLayoutEffect } from "react";
import { FEWEST_CORNERS } from "@/program/canvas/Zones";
import type { Position, Zone } from "@/program/document/document";
import { makeId } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { freeSpot } from "../state/freeSpot";
import { isTyping } from "../state/focus";
import { ZONE_TOOL } from "../state/tools";
import { finish, RESTING, takeTool } from "../state/tool";
import { say, useUi } from "../state/ui";
import { selectZone, useGestures } from "../state/gestures";
import { closes, freshNumber, freshZone, squareAround, withNextCorner } from "./shape";

/** Metres; a press so near to the first corner closes the zone. */
const CLOSING_M = 0.35;

export function pressZoneTool(open: OpenProgram, at: Position): void {
  const { corners } = useGestures.getState();
  if (closes(corners, at, CLOSING_M)) createZone(open, corners);
  else useGestures.setState({ corners: withNextCorner(corners, at) });
}

function createZone(open: OpenProgram, points: readonly Position[]): void {
  const { document, apply, t } = open;
  const id = makeId();
  const name = t("gesture.zone.fresh", { number: freshNumber(document) });
  apply([{ do: "set_zone", id, value: freshZone(name, points) }]);
  useGestures.setState({ corners: [] });
  useUi.setState((ui) => ({ gesture: finish(ui.gesture) }));
  selectZone(id);
}

export function changeZone(open: OpenProgram, id: string, change: Partial<Zone>): void {
  const zone = open.document.zones[id];
  if (zone) open.apply([{ do: "set_zone", id, value: { ...zone, ...change } }]);
}

export function removeZone(open: OpenProgram, id: string): void {
  open.apply([{ do: "set_zone", id, value: null }]);
  selectZone(null);
  say(open.t("gesture.zone.removed"), true);
}

/** Z takes the tool; Enter closes, Backspace takes a corner back, Escape gives up; Delete removes a selected zone. */
export function useZoneKeys(open: OpenProgram): void {
  useLayoutEffect(() => {
    const press = (event: KeyboardEvent) => {
      const busy = useUi.getState().dialog || isTyping(event.target) || event.ctrlKey || event.metaKey || event.altKey;
      if (busy || event.defaultPrevented || !open.canEdit || !zoneKey(open, event)) return;
      event.preventDefault();
      event.stopPropagation();
    };
    window.addEventListener("keydown", press, { capture: true });
    return () => window.removeEventListener("keydown", press, { capture: true });
  }, [open]);
}

function zoneKey(open: OpenProgram, event: KeyboardEvent): boolean {
  const { gesture } = useUi.getState();
  if (event.key.toLowerCase() === "z") {
    useUi.setState({ gesture: takeTool(gesture, ZONE_TOOL, true) });
    return true;
  }
  return gesture.tool === ZONE_TOOL ? drawingKey(open, event.key) : selectedKey(open, event);
}

function drawingKey(open: OpenProgram, key: string): boolean {
  const { corners } = useGestures.getState();
  if (key === "Enter" && corners.length >= FEWEST_CORNERS) createZone(open, corners);
  else if (key === "Enter" && corners.length === 0) createZone(open, squareAround(freeSpot(open)));
  else if (key === "Backspace") useGestures.setState({ corners: corners.slice(0, -1) });
  else if (key === "Escape") stopDrawing();
  else return false;
  return true;
}

function stopDrawing(): void {
  const { corners } = useGestures.getState();
  if (corners.length > 0) useGestures.setState({ corners: [] });
  else useUi.setState({ gesture: RESTING });
}

function selectedKey(open: OpenProgram, event: KeyboardEvent): boolean {
  const { zone } = useGestures.getState();
  if (zone === null || useUi.getState().selected.length > 0) return false;
  if (event.key === "Escape") selectZone(null);
  else if (event.key === "Delete" || event.key === "Backspace") removeZone(open, zone);
  else return false;
  return true;
}
