/** A floor check as it is looked at: for whose width, and which finding is shown on the map. */
import { useDebouncedValue } from "@mantine/hooks";
import { useState } from "react";
import { useFloorCheck } from "@/api/floorCheck";
import { useDevices } from "@/api/queries";
import type { FloorCheck, FloorFinding, SiteMap } from "@/api/types";
import { keyOf } from "./findingWords";

const [NARROWEST_M, WIDEST_M] = [0.1, 3];

export interface FloorCheckView {
  readonly check: FloorCheck | undefined;
  readonly error: Error | null;
  readonly isChecking: boolean;
  readonly again: () => void;
  /** What is written as the width of another robot, in metres; a text while somebody writes; empty: the site's own. */
  readonly width: number | string;
  readonly setWidth: (width: number | string) => void;
  readonly chosen: FloorFinding | undefined;
  readonly choose: (finding: FloorFinding) => void;
}

/** It is not asked for while somebody changes the map: what it says comes with the last change. */
export function useFloorCheckView(slug: string, map: SiteMap, enabled: boolean): FloorCheckView {
  const [width, setWidth] = useState<number | string>("");
  const [asked] = useDebouncedValue(width, 400);
  const [chosen, setChosen] = useState<string | null>(null);
  const devices = useDevices(slug).data ?? [];
  const isSound = typeof asked === "number" && asked >= NARROWEST_M && asked <= WIDEST_M;
  const {
    data: check,
    error,
    isFetching,
    refetch,
  } = useFloorCheck(slug, map, devices, {
    width_m: isSound ? asked : null,
    enabled,
  });
  return {
    check,
    error,
    isChecking: isFetching,
    again: () => void refetch(),
    width,
    setWidth,
    chosen: check?.findings.find((each) => keyOf(each) === chosen),
    choose: (finding) => setChosen((known) => (known === keyOf(finding) ? null : keyOf(finding))),
  };
}
