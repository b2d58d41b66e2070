/** A floor check as it is looked at: for whose width, and which finding is shown on the map. */
import { useDebouncedValue } from "@mantine/hooks";
import { useState } from "react";
import { useFloorCheck } from "@/api/floorCheck";
import { useDevices } from "@/api/queries";
import type { FloorCheck, FloorFinding, FloorRemedy, SiteMap } from "@/api/types";
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
  /** Whether what is written is no width that robots have; then the check is for the site's own. */
  readonly isOdd: boolean;
  /** For which width it is, in metres; null: the site's own. */
  readonly asked: number | null;
  readonly chosen: FloorFinding | undefined;
  readonly choose: (finding: FloorFinding) => void;
  /** What somebody thinks of doing about it, shown where it would be. */
  readonly ghost: FloorRemedy | null;
  readonly setGhost: (remedy: FloorRemedy | null) => void;
}

/** It is not asked for while somebody changes the map: what it says comes with the last change. */
export function useFloorCheckView(slug: string, map: SiteMap, enabled: boolean): FloorCheckView {
  const [width, setWidth] = useState<number | string>("");
  const [asked] = useDebouncedValue(width, 400);
  const [chosen, setChosen] = useState<string | null>(null);
  const [ghost, setGhost] = useState<FloorRemedy | null>(null);
  const devices = useDevices(slug).data ?? [];
  const isSound = typeof asked === "number" && asked >= NARROWEST_M && asked <= WIDEST_M;
  const width_m = isSound ? asked : null;
  const {
    data: check,
    error,
    isFetching,
    isPlaceholderData,
    refetch,
  } = useFloorCheck(slug, map, devices, {
    width_m,
    enabled,
  });
  const finding = check?.findings.find((each) => keyOf(each) === chosen);
  return {
    check,
    error,
    isChecking: isFetching || isPlaceholderData,
    again: () => void refetch(),
    width,
    setWidth,
    isOdd: typeof asked === "number" && !isSound,
    asked: width_m,
    chosen: finding,
    choose: (each) => {
      setGhost(null);
      setChosen((known) => (known === keyOf(each) ? null : keyOf(each)));
    },
    ghost: finding ? ghost : null,
    setGhost,
  };
}
