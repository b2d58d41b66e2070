/** The scale of the timeline: a moment is chosen on it, by pointer or keys. */
import type { KeyboardEvent, PointerEvent, ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { clock } from "@/design/clock";
import styles from "./runComments.module.css";

interface MomentScaleProps {
  className: string | undefined;
  /** Seconds from the left end of the scale to its right one, and those that the run has had. */
  span_s: number;
  elapsed_s: number;
  /** Null while none is chosen. */
  moment: number | null;
  onMoment: (t_s: number) => void;
  /** Enter: write about it; nothing for those who may not. */
  onWrite: ((t_s: number) => void) | null;
  children: ReactNode;
}

export function MomentScale(props: MomentScaleProps) {
  const { className, span_s, elapsed_s, moment, onMoment, onWrite, children } = props;
  const { t } = useTranslation();
  const now = moment ?? elapsed_s;
  const onPointer = (event: PointerEvent<HTMLDivElement>) => {
    if (event.type === "pointerdown") event.currentTarget.setPointerCapture(event.pointerId);
    else if (event.buttons === 0) return;
    const box = event.currentTarget.getBoundingClientRect();
    onMoment(within(((event.clientX - box.left) / box.width) * span_s, elapsed_s));
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const to = momentAfter(event, now, elapsed_s);
    if (event.key === "Enter" && onWrite) onWrite(now);
    else if (to !== null) onMoment(to);
    else return;
    event.preventDefault();
  };
  return (
    <div
      role="slider"
      tabIndex={0}
      className={[className, styles.chooser].join(" ")}
      aria-label={t(onWrite ? "comments.run.momentToWrite" : "comments.run.moment")}
      aria-valuemin={0}
      aria-valuemax={Math.round(elapsed_s)}
      aria-valuenow={Math.round(now)}
      aria-valuetext={clock(Math.round(now))}
      onPointerDown={onPointer}
      onPointerMove={onPointer}
      onKeyDown={onKeyDown}
    >
      {children}
      {moment === null ? null : (
        <b className={styles.moment} style={{ left: `${(moment / span_s) * 100}%` }} aria-hidden="true">
          {clock(moment)}
        </b>
      )}
    </div>
  );
}

const STEP_S = 1;
const LEAP_S = 10;

/** Where a key leads; null if it leads nowhere. */
export function momentAfter(
  { key, shiftKey }: Pick<KeyboardEvent, "key" | "shiftKey">,
  now: number,
  last: number,
): number | null {
  const by = shiftKey ? LEAP_S : STEP_S;
  if (key === "ArrowLeft" || key === "ArrowDown") return within(now - by, last);
  if (key === "ArrowRight" || key === "ArrowUp") return within(now + by, last);
  if (key === "PageDown") return within(now - LEAP_S, last);
  if (key === "PageUp") return within(now + LEAP_S, last);
  if (key === "Home") return 0;
  return key === "End" ? last : null;
}

function within(t_s: number, last: number): number {
  return Math.min(Math.max(t_s, 0), last);
}
