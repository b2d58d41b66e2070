/** A step on the map: number badge, icon, short text; its shape says what it is. */
import { Box } from "lucide-react";
import { memo, type CSSProperties } from "react";
import { VipoIcon } from "@/design/VipoIcon";
import type { Chip } from "../scene/chips";
import type { LevelOfDetail } from "../scene/detail";
import type { TextPart } from "../words/stepWords";
import { cornerMark, type OtherPerson, type StepState } from "./stepState";
import classes from "./stage.module.css";

export type { ComparedState, OtherPerson, StepState } from "./stepState";

export interface StepChipProps {
  chip: Chip;
  selected: boolean;
  state: StepState;
  other: OtherPerson | null;
  /** "Move added for you", where it is to be said. */
  note: string | null;
  detail: LevelOfDetail;
}

export const StepChip = memo(function StepChip(props: StepChipProps) {
  const { chip, selected, state, other, note, detail } = props;
  const style = { "--own": `var(--${chip.family})`, "--own-soft": `var(--${chip.family}-soft)` } as CSSProperties;
  return (
    <div
      className={classes.chip}
      style={{ ...style, width: chip.width, height: chip.height, ...otherStyle(other) }}
      data-shape={chip.shape}
      data-lod={detail}
      data-tag={chip.shape === "diamond" ? chip.tagSide : undefined}
      data-selected={selected || undefined}
      data-problem={chip.problem ?? undefined}
      data-state={(chip.shape === "note" ? null : state) ?? undefined}
      data-draft={chip.draft || undefined}
      data-inner={chip.inner || undefined}
    >
      {chip.shape === "diamond" ? <Diamond chip={chip} /> : <Face chip={chip} />}
      <Corner chip={chip} state={state} />
      {other && chip.shape !== "header" ? <span className={classes.flag}>{other.initials}</span> : null}
      {note ? (
        <span className={classes.note}>
          <VipoIcon name="move" size={12} />
          {note}
        </span>
      ) : null}
    </div>
  );
});

function otherStyle(other: OtherPerson | null): CSSProperties {
  return other ? ({ "--other": other.colour } as CSSProperties) : {};
}

function Face({ chip }: { chip: Chip }) {
  return (
    <>
      <span className={classes.face}>
        {chip.number ? <span className={classes.badge}>{chip.number}</span> : null}
        <span className={classes.icon}>
          {chip.kind === "pick_and_drop" ? <Box size={15} strokeWidth={2} /> : <VipoIcon name={chip.icon} size={15} />}
        </span>
        <Parts parts={chip.parts} />
      </span>
      {chip.condition ? (
        <span className={classes.tag}>
          <Parts parts={chip.condition} />
        </span>
      ) : null}
    </>
  );
}

function Diamond({ chip }: { chip: Chip }) {
  return (
    <>
      <span className={classes.diamond} aria-hidden="true" />
      <span className={classes.diamondWord}>
        <Parts parts={chip.parts} />
      </span>
      {chip.number ? <span className={classes.badge}>{chip.number}</span> : null}
      {chip.condition ? (
        <span className={classes.tag}>
          <Parts parts={chip.condition} />
        </span>
      ) : null}
    </>
  );
}

function Parts({ parts }: { parts: readonly TextPart[] }) {
  return (
    <span className={classes.text}>
      {parts.map((part, index) => (
        <span key={index} data-tone={part.tone}>
          {part.swatch ? <i className={classes.swatch} style={{ background: part.swatch }} /> : null}
          {part.text}
        </span>
      ))}
    </span>
  );
}

/** A frame's head leaves the badge to the frame's corner. */
function Corner({ chip, state }: { chip: Chip; state: StepState }) {
  const mark = chip.shape === "header" ? null : cornerMark(chip.problem, state);
  if (!mark) return null;
  return (
    <svg className={classes.corner} width={20} height={20} viewBox="-10 -10 20 20" aria-hidden="true">
      {mark}
    </svg>
  );
}
