import { Pause, Play, RotateCcw, SkipBack, SkipForward, StepForward } from "lucide-react";
import type { PointerEvent as ReactPointerEvent } from "react";
import { useTranslation } from "react-i18next";
import styles from "./Transport.module.css";
import { clock, tickEvery } from "@/design/clock";
import { useSize } from "@/map/plane/useSize";
import { SPEEDS } from "./speeds";
import { markerPlaces, type Segment } from "./timeline";

export interface Marker {
  number: number;
  kind: string;
  t_s: number;
  label: string;
}

interface TransportProps {
  t_s: number;
  duration_s: number;
  playing: boolean;
  speed: number;
  segments: Segment[];
  markers: Marker[];
  titleOf: (step: string) => string;
  onSeek: (t_s: number) => void;
  onPlay: () => void;
  onSpeed: (speed: number) => void;
  onStep: (direction: 1 | -1) => void;
}

function Buttons({ t_s, duration_s, playing, onSeek, onPlay, onStep }: TransportProps) {
  const { t } = useTranslation();
  const small = (label: string, onClick: () => void, icon: React.ReactNode) => (
    <button type="button" className={styles.small} aria-label={label} title={label} onClick={onClick}>
      {icon}
    </button>
  );
  return (
    <div className={styles.buttons}>
      {small(t("simulation.stepBack"), () => onStep(-1), <SkipBack size={18} />)}
      {small(t("simulation.restart"), () => onSeek(0), <RotateCcw size={18} />)}
      <button
        type="button"
        className={styles.play}
        aria-label={playing ? t("simulation.pause") : t("simulation.play")}
        onClick={onPlay}
      >
        {playing ? <Pause size={20} /> : <Play size={20} />}
      </button>
      {small(t("simulation.stepForward"), () => onStep(1), <StepForward size={18} />)}
      {small(t("simulation.toEnd"), () => onSeek(duration_s), <SkipForward size={18} />)}
      <span className={styles.srOnly} aria-live="off">
        {clock(t_s)}
      </span>
    </div>
  );
}

function Speed({ speed, onSpeed }: Pick<TransportProps, "speed" | "onSpeed">) {
  const { t } = useTranslation();
  return (
    <div className={styles.field}>
      <span className={styles.caption} id="speed-caption">
        {t("simulation.speed")}
      </span>
      <div className={styles.speeds} role="radiogroup" aria-labelledby="speed-caption">
        {SPEEDS.map((choice) => (
          <button
            key={choice}
            type="button"
            role="radio"
            aria-checked={choice === speed}
            className={styles.speed}
            aria-label={t("simulation.times", { speed: choice })}
            onClick={() => onSpeed(choice)}
          >
            {choice === 0.25 ? "¼" : choice === 0.5 ? "½" : choice}×
          </button>
        ))}
      </div>
    </div>
  );
}

function Bar({ segments, t_s, duration_s, titleOf }: TransportProps) {
  const lanes = Math.max(1, ...segments.map((segment) => segment.lane + 1));
  const part = (seconds: number) => `${(seconds / Math.max(duration_s, 0.001)) * 100}%`;
  return (
    <div className={styles.bar}>
      {segments.map((segment) => {
        const state = t_s >= segment.ended_s ? styles.past : t_s >= segment.started_s ? styles.now : styles.future;
        return (
          <span
            key={`${segment.step}-${segment.started_s}`}
            className={`${styles.segment} ${state}`}
            title={titleOf(segment.step)}
            style={{
              left: part(segment.started_s),
              width: part(segment.ended_s - segment.started_s),
              top: `${(segment.lane / lanes) * 100}%`,
              height: `calc(${100 / lanes}% - 2px)`,
            }}
          >
            {titleOf(segment.step)}
          </span>
        );
      })}
    </div>
  );
}

function Ticks({ duration_s }: { duration_s: number }) {
  const every = tickEvery(duration_s);
  const ticks = Array.from({ length: Math.floor(duration_s / every) + 1 }, (_, index) => index * every);
  return (
    <div className={styles.ticks} aria-hidden="true">
      {ticks.map((tick) => (
        <span key={tick} style={{ left: `${(tick / Math.max(duration_s, 0.001)) * 100}%` }}>
          {clock(tick)}
        </span>
      ))}
    </div>
  );
}

/** Dragging anywhere on the track scrubs; the hidden range input gives the same to the keyboard. */
function Track(props: TransportProps) {
  const { t_s, duration_s, markers, onSeek } = props;
  const { t } = useTranslation();
  const [track, { width }] = useSize<HTMLDivElement>();
  const inTime = [...markers].sort((one, other) => one.t_s - other.t_s);
  const places = markerPlaces(inTime.map(({ t_s }) => (t_s / Math.max(duration_s, 0.001)) * width));
  const seek = (event: ReactPointerEvent) => {
    const box = track.current?.getBoundingClientRect();
    if (!box) return;
    onSeek(Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1) * duration_s);
  };
  return (
    <div
      ref={track}
      className={styles.track}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        seek(event);
      }}
      onPointerMove={(event) => {
        if (event.buttons === 1) seek(event);
      }}
    >
      {inTime.map((marker, index) => (
        <span
          key={marker.number}
          data-kind={marker.kind}
          className={styles.marker}
          title={marker.label}
          style={{ left: places[index] }}
        >
          {marker.number}
        </span>
      ))}
      <Bar {...props} />
      <Ticks duration_s={duration_s} />
      <span className={styles.head} style={{ left: `${(t_s / Math.max(duration_s, 0.001)) * 100}%` }} />
      <input
        className={styles.range}
        type="range"
        min={0}
        max={duration_s}
        step={0.1}
        value={t_s}
        aria-label={t("simulation.scrub")}
        aria-valuetext={clock(t_s)}
        onChange={(event) => onSeek(Number(event.target.value))}
      />
    </div>
  );
}

/** Play, pause, scrub and jump through the recording. */
export function Transport(props: TransportProps) {
  const { t } = useTranslation();
  return (
    <section className={styles.transport} aria-label={t("simulation.transport")}>
      <Buttons {...props} />
      <Speed speed={props.speed} onSpeed={props.onSpeed} />
      <div className={styles.field}>
        <span className={styles.caption}>{t("simulation.simulatedTime")}</span>
        <span className={styles.time}>
          {clock(props.t_s)} <small>/ {clock(props.duration_s)}</small>
        </span>
      </div>
      <Track {...props} />
    </section>
  );
}
