/** The lines that can be pressed now: those at what is selected or pointed at. One SVG in the map's plane. */
import { memo } from "react";
import { PathLine } from "@/map/PathLine";
import { angleOf, roundedPath, towards, type PixelPoint } from "@/map/plane/paths";
import type { BranchRef } from "../document/tree";
import { furthest, type StepState } from "../painting/looks";
import { type Link, wordPlace } from "../scene/links";
import type { LinePiece, SharedRoute } from "../scene/pieces";
import classes from "./stage.module.css";

export interface DrawingProps {
  lines: readonly LinePiece[];
  selected: ReadonlySet<string>;
  stateOf: (step: string) => StepState;
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
  return (
    <svg className={classes.drawing} width={1} height={1} aria-hidden="true">
      {props.lines.map((line) => {
        if ("route" in line) return <RouteShape key={line.id} route={line.route} {...props} />;
        return "link" in line ? <LinkShape key={line.id} link={line.link} {...props} /> : null;
      })}
    </svg>
  );
});

/** Steps that drive the same way share one line, in the state of the one that has come furthest. */
function RouteShape({ route, selected, stateOf, onSelectStep }: { route: SharedRoute } & DrawingProps) {
  const shown = furthest(route, stateOf);
  if (!shown) return null;
  const state = stateOf(shown.step);
  return (
    <g>
      <PathLine
        points={route.points}
        colour={routeColour(state)}
        opacity={routeOpacity(state, shown.guessed)}
        dashed={state === "planned" || state === "running"}
        wide={route.steps.some(({ step }) => selected.has(step)) || state === "running"}
      />
      {onSelectStep ? (
        <path
          className={classes.hit}
          d={roundedPath(route.points)}
          onClick={(event) => onSelectStep(shown.step, event.shiftKey)}
        />
      ) : null}
    </g>
  );
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
