/** What somebody edits on the map may be removed by somebody else meanwhile: then that is said. */
import { notifications } from "@mantine/notifications";
import { useEffect, useRef } from "react";
import { useTranslation } from "react-i18next";
import { ApiProblem } from "@/api/client";

const GONE: readonly string[] = ["no_such_place", "no_such_zone"];

interface Thing {
  readonly id: string;
  readonly name: string;
}

/**
 * Say when the thing that is `edited` is no longer among the `things` of the map, and leave it.
 *
 * Who removes it themselves leaves it first. The notice offers nothing: the thing and what was not kept of it are gone.
 */
export function useRemovedMeanwhile(edited: Thing | null, things: readonly Thing[], leave: () => void): void {
  const { t } = useTranslation();
  const last = useRef<Thing | null>(null);
  useEffect(() => {
    const before = last.current;
    last.current = edited;
    if (edited || !before || things.some(({ id }) => id === before.id)) return;
    leave();
    const message = t("place.removedMeanwhile", { name: before.name });
    notifications.show({ message, color: "yellow", autoClose: 12_000 });
  }, [edited, things]); // oxlint-disable-line react/exhaustive-deps -- when the map or the choice is another
}

/** Whether the server has refused because the thing is not there any more. */
export const isGone = (error: Error): boolean => error instanceof ApiProblem && GONE.includes(error.code);
