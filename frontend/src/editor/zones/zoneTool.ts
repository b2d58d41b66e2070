/** The zone tool: corner after corner, closed on the first one or with Enter. */
import { FEWEST_CORNERS } from "@/program/canvas/Zones";
import type { Position, Zone } from "@/program/document/document";
import { makeId } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { freeSpot } from "../state/freeSpot";
import { finish, RESTING } from "../state/tool";
import { useUi } from "../state/ui";
import { doAndSay } from "../state/undoing";
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

/** What others have changed meanwhile stays, and what they have removed stays away. */
export function changeZone(open: OpenProgram, id: string, change: Partial<Zone>): void {
  const zone = open.shared.getDocument().zones[id];
  if (zone) open.apply([{ do: "set_zone", id, value: { ...zone, ...change } }]);
}

export function removeZone(open: OpenProgram, id: string): void {
  doAndSay(
    open,
    () => open.apply([{ do: "set_zone", id, value: null }]),
    () => open.t("gesture.zone.removed"),
  );
  selectZone(null);
}

/** Enter: what is drawn so far is the zone; without a corner a square is set down. False while corners are missing. */
export function closeZone(open: OpenProgram): boolean {
  const { corners } = useGestures.getState();
  if (corners.length >= FEWEST_CORNERS) createZone(open, corners);
  else if (corners.length === 0) createZone(open, squareAround(freeSpot(open)));
  else return false;
  return true;
}

/** Take back the last corner. */
export function dropCorner(): void {
  useGestures.setState(({ corners }) => ({ corners: corners.slice(0, -1) }));
}

/** Give up the corners, and without any the tool. */
export function leaveZone(): void {
  const { corners } = useGestures.getState();
  if (corners.length > 0) useGestures.setState({ corners: [] });
  else useUi.setState({ gesture: RESTING });
}
