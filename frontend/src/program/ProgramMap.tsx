/** A program on its map to look at: for the run monitor and the simulation. */
import { type ReactNode, useMemo } from "react";
import type { FloorPlan } from "@/map/floor/floor";
import type { Insets } from "@/map/plane/projection";
import type { RobotSource } from "@/map/robots/robots";
import type { NodeLooks } from "./canvas/buildNodes";
import { MapControls } from "./canvas/MapControls";
import { MapStage } from "./canvas/MapStage";
import type { OtherPerson, StepState } from "./canvas/StepChip";
import { useScene } from "./canvas/useScene";
import type { Compiled, ProgramDocument } from "./document/document";
import { wellFormed } from "./document/wellFormed";
import { chipLabel } from "./scene/announcements";
import { Zones } from "./canvas/Zones";
import type { SiteDevice } from "./surroundings";

export interface ProgramMapProps {
  /** The site's slug, for its routes. */
  site: string | undefined;
  plan: FloorPlan | null;
  devices: readonly SiteDevice[];
  document: ProgramDocument;
  compiled: Compiled | null | undefined;
  /** Each step's status in a run or rehearsal; steps that are not in it are planned. Left out: no run. */
  statuses?: Readonly<Record<string, { readonly status: string }>>;
  robots?: RobotSource;
  trails?: boolean;
  selected?: string | null;
  onSelect?: (step: string | null) => void;
  onSelectDevice?: (device: string) => void;
  /** Zoom buttons at the bottom right. */
  controls?: boolean;
  /** More in the map's plane, in drawing pixels. */
  plane?: ReactNode;
}

const INSETS: Insets = { left: 36, top: 36, right: 24, bottom: 24 };
const NOBODY: ReadonlyMap<string, OtherPerson> = new Map();

export function ProgramMap(props: ProgramMapProps) {
  const { plan, devices, statuses, selected = null, onSelect } = props;
  const document = useMemo(() => wellFormed(props.document), [props.document]);
  const { scene, t, surroundings } = useScene({
    site: props.site,
    plan,
    document,
    compiled: props.compiled,
    devices,
  });
  const looks = useMemo<NodeLooks>(
    () => ({
      selected: new Set(selected ? [selected] : []),
      stateOf: (step) => stateFrom(statuses, step),
      othersOn: NOBODY,
      lightOf: () => null,
      captionOf: () => null,
      noteOf: () => null,
      labelOf: (chip) => chipLabel(chip, { document, surroundings, t }),
      startLabel: t("start"),
      editable: false,
    }),
    [selected, statuses, document, surroundings, t],
  );
  return (
    <MapStage
      plan={plan}
      devices={devices}
      scene={scene}
      looks={looks}
      robots={props.robots}
      trails={props.trails}
      insets={INSETS}
      label={t("map_label")}
      mode="pan"
      under={<Zones document={document} t={t} />}
      plane={props.plane}
      onStep={(step) => onSelect?.(step)}
      onDevice={(device) => props.onSelectDevice?.(device)}
      onFloor={() => onSelect?.(null)}
    >
      {props.controls ? <MapControls plan={plan} scene={scene} insets={INSETS} /> : null}
    </MapStage>
  );
}

function stateFrom(statuses: ProgramMapProps["statuses"], step: string): StepState {
  if (!statuses) return null;
  const status = statuses[step]?.status;
  return status === "running" || status === "done" || status === "failed" || status === "skipped" ? status : "planned";
}
