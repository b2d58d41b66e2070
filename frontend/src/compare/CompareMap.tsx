/** Both sides on one map: changes with their tiles, ghosts where something was, all that is the same dimmed. */
import { Equal, EqualNot, Minus, MoveHorizontal, Plus } from "lucide-react";
import { useStore } from "@xyflow/react";
import { useEffect, useMemo, useRef } from "react";
import type { ChangeKind, Difference } from "@/api/types";
import type { FloorPlan } from "@/map/floor/floor";
import type { Insets } from "@/map/plane/projection";
import type { NodeLooks } from "@/program/canvas/buildNodes";
import { MapControls } from "@/program/canvas/MapControls";
import { MapStage } from "@/program/canvas/MapStage";
import { type OtherPerson, StepChip } from "@/program/canvas/StepChip";
import { useStage } from "@/program/canvas/stageContext";
import { Zones } from "@/program/canvas/Zones";
import type { PixelPoint } from "@/map/plane/paths";
import { chipLabel } from "@/program/scene/announcements";
import { detailAt } from "@/program/scene/detail";
import type { SiteDevice } from "@/program/surroundings";
import classes from "./map.module.css";
import type { Ghost, Tile } from "./marks";
import type { Pictures } from "./usePictures";

const INSETS: Insets = { left: 44, top: 44, right: 24, bottom: 24 };
const NOBODY: ReadonlyMap<string, OtherPerson> = new Map();
const FLIGHT_MS = 280;
/** What lies so far inside the map, pixels, and is drawn so large needs no flight: the view stays where it is. */
const SIGHT = 70;
const LEGIBLE = 0.62;

const SIGNS: Record<ChangeKind, typeof Plus> = {
  added: Plus,
  removed: Minus,
  changed: EqualNot,
  moved: MoveHorizontal,
};

/** The sign of a kind of change, in its colour; the word stands beside it wherever it is used. */
export function ChangeTile({ kind, size = 18 }: { kind: ChangeKind | "same"; size?: number }) {
  const Sign = kind === "same" ? Equal : SIGNS[kind];
  return (
    <span className={classes.tile} data-kind={kind} style={{ width: size, height: size }} aria-hidden="true">
      <Sign size={size - 6} strokeWidth={2.6} />
    </span>
  );
}

interface CompareMapProps {
  plan: FloorPlan | null;
  devices: readonly SiteDevice[];
  difference: Difference;
  /** Both sides are one version: nothing of it is pale beside what has changed. */
  isOne: boolean;
  pictures: Pictures;
  chosen: string | null;
  /** How often something was chosen. */
  round: number;
  /** Where the view goes when a change is chosen. */
  spot: PixelPoint | null;
  label: string;
  onChoose: (key: string) => void;
}

export function CompareMap(props: CompareMapProps) {
  const { plan, devices, difference, isOne, pictures, chosen, onChoose } = props;
  const { drawn, ghosts, tiles, parts } = pictures;
  const { states, looks } = useLooks(difference, isOne, parts, chosen);
  const choose = (step: string) => {
    if (states.has(step)) onChoose(`steps/${step}`);
  };
  return (
    <MapStage
      plan={plan}
      devices={devices}
      scene={drawn}
      looks={looks}
      insets={INSETS}
      label={props.label}
      mode="pan"
      under={<Zones document={parts.document} t={parts.t} />}
      plane={<Marks ghosts={ghosts} tiles={tiles} chosen={chosen} onChoose={onChoose} />}
      onStep={choose}
    >
      <Flight spot={props.spot} round={props.round} />
      <MapControls plan={plan} scene={drawn} insets={{ ...INSETS, right: 14, bottom: 12 }} />
    </MapStage>
  );
}

/** Changed steps in their state, all others the same. */
function useLooks(difference: Difference, isOne: boolean, parts: Pictures["parts"], chosen: string | null) {
  const states = useMemo(
    () => new Map(difference.constructs.filter((each) => each.root === "steps").map((each) => [each.id, each.kind])),
    [difference],
  );
  const looks = useMemo<NodeLooks>(
    () => ({
      selected: new Set(chosen?.startsWith("steps/") ? [chosen.slice("steps/".length)] : []),
      stateOf: (step) => states.get(step) ?? (isOne ? null : "same"),
      othersOn: NOBODY,
      lightOf: () => null,
      captionOf: () => null,
      noteOf: () => null,
      labelOf: (chip) => chipLabel(chip, { document: parts.document, surroundings: parts.surroundings, t: parts.t }),
      startLabel: parts.t("start"),
      editable: false,
    }),
    [chosen, isOne, states, parts],
  );
  return { states, looks };
}

interface MarksProps {
  ghosts: readonly Ghost[];
  tiles: readonly Tile[];
  chosen: string | null;
  onChoose: (key: string) => void;
}

function Marks({ ghosts, tiles, chosen, onChoose }: MarksProps) {
  const detail = useStore(({ transform }) => detailAt(transform[2]));
  return (
    <>
      <svg className={classes.ways} width={1} height={1} aria-hidden="true">
        {ghosts.map(({ chip, to }) =>
          to ? <path key={chip.id} d={`M${chip.at.x} ${chip.at.y}L${to.x} ${to.y}`} /> : null,
        )}
      </svg>
      {ghosts.map(({ chip, kind }) => (
        // The same change stands in the list beside the map, which is where the keyboard reaches it.
        <div
          key={chip.id}
          className={classes.ghost}
          data-kind={kind}
          style={{ left: chip.at.x, top: chip.at.y }}
          onPointerDown={() => onChoose(`steps/${chip.id}`)}
          aria-hidden="true"
        >
          <StepChip
            chip={chip}
            selected={kind === "removed" && chosen === `steps/${chip.id}`}
            state={kind}
            other={null}
            note={null}
            detail={detail}
          />
        </div>
      ))}
      {tiles.map(({ key, kind, at }) => (
        <div
          key={key}
          className={classes.corner}
          style={{ left: at.x, top: at.y }}
          data-chosen={key === chosen || undefined}
        >
          <ChangeTile kind={kind} size={20} />
        </div>
      ))}
    </>
  );
}

/** The view goes to what is chosen, once for each choice. */
function Flight({ spot, round }: { spot: PixelPoint | null; round: number }) {
  const { flow, viewport, pane } = useStage();
  const last = useRef(0);
  useEffect(() => {
    if (round === last.current || pane.width === 0) return;
    last.current = round;
    if (!spot) return;
    const view = viewport.get();
    const at = { x: spot.x * view.zoom + view.x, y: spot.y * view.zoom + view.y };
    const inside = at.x > SIGHT && at.y > SIGHT && at.x < pane.width - SIGHT && at.y < pane.height - SIGHT;
    if (inside && view.zoom >= LEGIBLE) return;
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    void flow.setCenter(spot.x, spot.y, { zoom: Math.max(view.zoom, LEGIBLE), duration: still ? 0 : FLIGHT_MS });
  }, [spot, round, flow, viewport, pane]);
  return null;
}
