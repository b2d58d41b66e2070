/** A template moving on the site's own map: where the robot drives, and what it does where; still for who wants that. */
import { useMediaQuery } from "@mantine/hooks";
import { Pause, Play } from "lucide-react";
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import { isRobot } from "@/map/devices/device";
import { PathLine } from "@/map/PathLine";
import { type PixelPoint, pathLength } from "@/map/plane/paths";
import { StaticMap } from "@/map/StaticMap";
import { useRoutes } from "@/program/canvas/useRoutes";
import type { ProgramDocument } from "@/program/document/document";
import { EMPTY_DOCUMENT } from "@/program/document/document";
import { routePoints } from "@/program/scene/scene";
import { keyOfPath } from "@/program/scene/stepPaths";
import { type Spot, spotOf } from "@/program/surroundings";
import { floorMark } from "@/map/floor/floor";
import { useOpenProgram } from "../state/context";
import classes from "./beginning.module.css";
import type { Bound } from "./templates";

const NOWHERE: ProgramDocument = EMPTY_DOCUMENT;
/** Drawing pixels a second, and the least time of a round: quick enough to be seen whole, slow enough to be followed. */
const SPEED = 170;
const LEAST_S = 4;

export function TemplatePreview({ bound, round }: { bound: Bound; round: boolean }) {
  const { t } = useTranslation();
  const { plan, devices } = useOpenProgram();
  const still = useMediaQuery("(prefers-reduced-motion: reduce)") ?? false;
  const [held, setHeld] = useState(false);
  const { spots, legs } = useLegs(bound, round);
  const seconds = Math.max(LEAST_S, legs.reduce((sum, leg) => sum + pathLength(leg), 0) / SPEED);
  return (
    <div className={classes.preview}>
      <StaticMap
        plan={plan}
        devices={devices.filter((each) => !isRobot(each))}
        named
        label={t("first.templates.preview")}
      >
        {legs.map((leg, index) => (
          <PathLine key={index} points={leg} />
        ))}
        {still || legs.length === 0 ? null : (
          <g
            className={classes.walker}
            data-held={held || undefined}
            style={{ offsetPath: `path("${lineOf(legs.flat())}")`, animationDuration: `${seconds}s` }}
          >
            <circle r={13} />
            <path d="M-5 4v-8h10v8z" />
          </g>
        )}
        {spots.map((spot, index) => (
          <Numbers key={index} at={spot.at} bound={bound} stop={index} />
        ))}
      </StaticMap>
      {still ? null : (
        <IconButton
          label={t(held ? "first.templates.play" : "first.templates.hold")}
          className={classes.hold}
          onClick={() => setHeld(!held)}
        >
          {held ? <Play size={16} aria-hidden="true" /> : <Pause size={16} aria-hidden="true" />}
        </IconButton>
      )}
    </div>
  );
}

/** The numbers of what is done at a stop, as the list beside the map has them. */
function Numbers({ at, bound, stop }: { at: PixelPoint; bound: Bound; stop: number }) {
  const numbers = bound.does.flatMap((each, index) => (each.stop === stop ? [index + 1] : []));
  const width = 16 + 18 * numbers.length;
  return (
    <g className={classes.numbers} transform={`translate(${at.x} ${at.y})`}>
      <rect x={-width / 2} y={-13} width={width} height={26} rx={13} />
      <text textAnchor="middle" y={5}>
        {numbers.join(", ")}
      </text>
    </g>
  );
}

function useLegs({ stops }: Bound, round: boolean): { spots: readonly Spot[]; legs: readonly PixelPoint[][] } {
  const { site, plan, surroundings } = useOpenProgram();
  const spots = useMemo(
    () => stops.flatMap(({ place }) => spotOf(place, surroundings, NOWHERE, null) ?? []),
    [stops, surroundings],
  );
  const ends = useMemo(() => {
    const next = [...spots.slice(1), ...(round ? spots.slice(0, 1) : [])];
    return next.map((to, index) => ({ from: spots[index] ?? to, to }));
  }, [spots, round]);
  const keys = useMemo(() => ends.map(({ from, to }) => keyOfPath(from, to)), [ends]);
  const routes = useRoutes(site.slug, floorMark(plan), keys);
  return { spots, legs: ends.map((each, index) => routePoints(each, routes(keys[index] ?? ""))) };
}

function lineOf(points: readonly PixelPoint[]): string {
  return points.map(({ x, y }, index) => `${index === 0 ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`).join(" ");
}
