/** Moves a place or a machine as a remedy says, and back, unless somebody has moved it since. */
import { notifications } from "@mantine/notifications";
import { useTranslation } from "react-i18next";
import { useMoveOnMap, type Moved } from "@/api/moves";
import type { Device, FloorRemedy, SiteMap } from "@/api/types";
import { tellRefusal } from "@/shell/refusal";
import { tellWithUndo } from "./undoNotice";

export function useMoves(slug: string, map: SiteMap, devices: readonly Device[]) {
  const { t } = useTranslation();
  const { mutateAsync, isPending } = useMoveOnMap(slug);

  /** What is said afterwards comes also to who has left the finding, which is gone once it is mended. */
  const send = (moved: Moved, name: string, tell: () => void) => {
    const told = (isDone: boolean) => {
      if (isDone) tell();
      else notifications.show({ message: t("floorCheck.remedy.movedSince", { name }) });
    };
    mutateAsync(moved).then(told, (error: Error) => tellRefusal(error, t));
  };

  const move = (remedy: FloorRemedy, name: string) => {
    const machine = devices.find(({ id }) => id === remedy.target);
    const stood = machine?.location ?? map.places.find(({ id }) => id === remedy.target);
    if (!stood) return;
    const there = { kind: machine ? "machine" : "place", id: remedy.target } as const;
    const [before, after] = [[stood.x, stood.y] as const, [remedy.x, remedy.y] as const];
    const isReal = machine !== undefined && !machine.simulated;
    const tellUndone = () => notifications.show({ message: t("floorCheck.remedy.undone", { name }) });
    const undo = () => send({ ...there, from: after, to: before }, name, tellUndone);
    send({ ...there, from: before, to: after }, name, () =>
      tellWithUndo(t(isReal ? "floorCheck.remedy.movedReal" : "floorCheck.remedy.moved", { name }), undo),
    );
  };
  return { move, isMoving: isPending };
}
