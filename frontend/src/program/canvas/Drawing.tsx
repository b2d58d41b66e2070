/** Everything of the drawing that is a line: hulls, routes, dotted links, frames. One SVG in the map's plane. */
import { memo } from "react";
import { PathLine } from "@/map/PathLine";
import { angleOf, roundedOutline, roundedPath, towards, type PixelPoint } from "@/map/plane/paths";
import type { BranchRef } from "../document/tree";
import type { Hull } from "../scene/hulls";
import { type Link, wordPlace } from "../scene/links";
import type { RouteShape } from "../scene/stepPaths";
import type { Scene } from "../scene/scene";
import { FrameShape } from "./FrameShape";
import classes from "./stage.module.css";
import type { OtherPerson, StepState } from "./StepChip";

export interface DrawingProps {
  scene: Scene;
  selected: ReadonlySet<string>;
  stateOf: (step: string) => StepState;
  othersOn: ReadonlyMap<string, OtherPerson>;
  onSelectStep?: (step: string, add: boolean) => void;
  /** A press on a link or stub: the next step goes there. */
  onSelectLink?: (link: Link) => void;
  chosenLink?: string | null;
  /** What an open branch, one without a step, says to whoever may draw into it. */
  targetWords?: (into: BranchRef) => string;
  /** A press on the word of an If's arrow: true and false change their steps. */
  onSwap?: (step: string) => void;
  swapLabel?: string;
}

export const Drawing = memo(function Drawing(props: DrawingProps) {
  const { scene, selected, stateOf, onSelectStep } = props;
  return (
    <svg className={classes.drawing} width={1} height={1} aria-hidden="true">
      {scene.hulls.map((hull) => (
        <HullShape key={hull.functionId} hull={hull} />
      ))}
      {drawnRoutes(scene.routes, stateOf).map(({ step, points, guessed, sharers }) => (
        <g key={step}>
          <PathLine
            points={points}
            colour={routeColour(stateOf(step))}
            opacity={routeOpacity(stateOf(step), guessed)}
            dashed={stateOf(step) === "planned" || stateOf(step) === "running"}
            wide={sharers.some((each) => selected.has(each)) || stateOf(step) === "running"}
          />
          {onSelectStep ? (
            <path
              className={classes.hit}
              d={roundedPath(points)}
              onClick={(event) => onSelectStep(step, event.shiftKey)}
            />
          ) : null}
        </g>
      ))}
      {outerFirst(scene.frames).map((frame) => (
        <FrameShape
          key={frame.id}
          frame={frame}
          state={stateOf(frame.id)}
          selected={selected.has(frame.id)}
          problem={scene.chips.get(frame.id)?.problem ?? null}
          other={props.othersOn.get(frame.id) ?? null}
        />
      ))}
      {scene.frames.map((frame) =>
        props.targetWords && frame.empty && selected.has(frame.id) ? (
          <g key={frame.id} className={classes.link}>
            <TargetWords
              words={props.targetWords({ parent: frame.id, branch: "body" })}
              x={(frame.box.left + frame.box.right) / 2}
              y={frame.box.bottom + 20}
              textAnchor="middle"
            />
          </g>
        ) : null,
      )}
      {scene.links.map((link) => (
        <LinkShape key={link.id} link={link} {...props} />
      ))}
    </svg>
  );
});

/** Inner frames lie on the frames around them. */
function outerFirst(frames: Scene["frames"]): Scene["frames"] {
  return [...frames].reverse();
}

/** Steps that drive the same way share one line, in the state of the one that has come furthest. */
function drawnRoutes(routes: readonly RouteShape[], stateOf: DrawingProps["stateOf"]) {
  const rank = (step: string) => ["running", "failed", "done"].indexOf(stateOf(step) ?? "");
  const byLine = new Map<RouteShape["points"], RouteShape[]>();
  for (const route of routes) byLine.set(route.points, [...(byLine.get(route.points) ?? []), route]);
  return [...byLine.values()].flatMap((sharing) => {
    const ranked = sharing.filter((route) => rank(route.step) >= 0).sort((a, b) => rank(a.step) - rank(b.step));
    const shown = ranked[0] ?? sharing[0];
    return shown ? [{ ...shown, sharers: sharing.map((route) => route.step) }] : [];
  });
}

function routeColour(state: StepState): string {
  if (state === "done") return "var(--done)";
  if (state === "running") return "var(--busy)";
  return state === "failed" ? "var(--error)" : "var(--motion)";
}

function routeOpacity(state: StepState, guessed: boolean): number {
  // A line that may cross a wall is never shown: a way appears when the server has found it.
  if (guessed) return 0;
  if (state === "planned" || state === "skipped") return 0.45;
  if (state === "done") return 0.65;
  if (state === "same") return 0.3;
  return 1;
}

function HullShape({ hull }: { hull: Hull }) {
  return (
    <g className={classes.hull}>
      {hull.outlines.map((outline, index) => (
        <path key={index} d={roundedOutline(outline)} />
      ))}
    </g>
  );
}

function LinkShape(props: { link: Link } & DrawingProps) {
  const { link, selected, stateOf, onSelectLink, chosenLink } = props;
  const [end, before] = [link.points.at(-1), link.points.at(-2)];
  if (!end || !before) return null;
  const near = [link.from, link.to].some((step) => step !== null && selected.has(step));
  const faint = link.tone === "then" && !near;
  const line = roundedPath([...link.points.slice(0, -1), towards(end, before, 5)], 10);
  const planned = link.to !== null && ["planned", "same"].includes(stateOf(link.to) ?? "");
  return (
    <g
      className={classes.link}
      data-tone={link.tone}
      data-faint={faint || planned || undefined}
      data-chosen={chosenLink === link.id || undefined}
    >
      <path d={line} />
      <path d="M-6 -4.5 0 0 -6 4.5" className={classes.arrow} transform={turned(end, before)} />
      {link.to === null ? <OpenEnd {...props} end={end} before={before} near={near} /> : null}
      {onSelectLink ? (
        <path className={classes.hit} d={line} onClick={() => onSelectLink(link)}>
          <title>{link.word ?? ""}</title>
        </path>
      ) : null}
      {link.word ? <LinkWord link={link} word={link.word} onSwap={swapOf(props)} label={props.swapLabel} /> : null}
    </g>
  );
}

/** The end of a branch without a step: a place to press, which says what is drawn there while its step is looked at. */
function OpenEnd(props: { link: Link; end: PixelPoint; before: PixelPoint; near: boolean } & DrawingProps) {
  const { link, end, before, near, onSelectLink, targetWords } = props;
  const chosen = props.chosenLink === link.id;
  const invites = targetWords !== undefined && (near || chosen);
  return (
    <>
      <circle cx={end.x} cy={end.y} r={invites ? 9 : 5} className={classes.stubEnd} />
      {invites ? <path className={classes.plus} d={`M${end.x - 4} ${end.y}h8M${end.x} ${end.y - 4}v8`} /> : null}
      {onSelectLink ? (
        <circle cx={end.x} cy={end.y} r={20} className={classes.target} onClick={() => onSelectLink(link)} />
      ) : null}
      {invites ? <TargetWords words={targetWords(link.into)} {...besideEnd(end, before)} /> : null}
    </>
  );
}

function TargetWords({
  words,
  ...place
}: {
  words: string;
  x: number;
  y: number;
  textAnchor: "start" | "middle" | "end";
}) {
  return (
    <text className={classes.targetWords} {...place}>
      {words}
    </text>
  );
}

/** Beyond the end, where the branch does not come from. */
function besideEnd(end: PixelPoint, before: PixelPoint) {
  const [dx, dy] = [end.x - before.x, end.y - before.y];
  if (Math.abs(dx) > Math.abs(dy))
    return { x: end.x + Math.sign(dx) * 14, y: end.y + 4, textAnchor: dx > 0 ? ("start" as const) : ("end" as const) };
  return { x: end.x, y: end.y + (dy > 0 ? 24 : -15), textAnchor: "middle" as const };
}

/** Only the words of an If can change places. */
function swapOf({ link, onSwap }: { link: Link } & DrawingProps): (() => void) | undefined {
  const { parent, branch } = link.into;
  return onSwap && link.from === parent && (branch === "then" || branch === "else") ? () => onSwap(parent) : undefined;
}

function turned(end: PixelPoint, before: PixelPoint): string {
  return `translate(${end.x} ${end.y}) rotate(${angleOf(before, end)})`;
}

/** The word stands beside the first stretch of its arrow. */
function LinkWord({ link, word, onSwap, label }: { link: Link; word: string; onSwap?: () => void; label?: string }) {
  const at = wordPlace(link);
  if (!at) return null;
  return (
    <text className={onSwap ? classes.swap : undefined} x={at.x} y={at.y} textAnchor={at.anchor} onClick={onSwap}>
      {word}
      {onSwap ? <title>{label}</title> : null}
    </text>
  );
}
