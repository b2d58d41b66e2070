import { MessageSquare } from "lucide-react";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import type { GrowingTimeline } from "@/api/runs";
import type { Device } from "@/api/types";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import { clock, tickEvery } from "@/design/clock";
import { type Bar, ganttOf, type RobotOf } from "./gantt";
import { MomentPins } from "./comments/MomentPins";
import { MomentScale } from "./comments/MomentScale";
import type { RunComments } from "./comments/useRunComments";
import styles from "./Timeline.module.css";

interface TimelineProps {
  timeline: GrowingTimeline;
  devices: readonly Device[];
  elapsed_s: number;
  over: boolean;
  numberOf: (step: string) => string;
  robotOf: RobotOf;
  onSelect: (step: string) => void;
  comments: RunComments;
  /** Begin a comment on a moment. */
  onWrite: (t_s: number) => void;
}

function kindOf(bar: Bar): string {
  if (bar.kind === "wait") return "wait";
  if (bar.failed) return "failed";
  return bar.ended_s === null ? "running" : "done";
}

function BarButton({ bar, span_s, props }: { bar: Bar; span_s: number; props: TimelineProps }) {
  const { t } = useTranslation();
  const end = bar.ended_s ?? props.elapsed_s;
  const kind = kindOf(bar);
  const number = bar.count > 1 ? `${bar.count} ×` : props.numberOf(bar.step);
  const text = `${number} ${t(`run.bar.${kind}`)}, ${clock(bar.started_s)}–${clock(end)}`;
  return (
    <button
      type="button"
      className={styles.bar}
      data-kind={kind}
      title={text}
      aria-label={text}
      style={{
        left: `${(bar.started_s / span_s) * 100}%`,
        width: `${(Math.max(end - bar.started_s, 0) / span_s) * 100}%`,
      }}
      onClick={() => props.onSelect(bar.step)}
    >
      {number}
    </button>
  );
}

/** Who worked when: a row a device, robots first. */
export function Timeline(props: TimelineProps) {
  const { t } = useTranslation();
  const { devices, elapsed_s, over, comments, onWrite } = props;
  const rows = useRows(props);
  const span_s = Math.max(10, elapsed_s * (over ? 1.02 : 1.15));
  const every = tickEvery(span_s);
  const ticks = Array.from({ length: Math.floor(span_s / every) + 1 }, (_, index) => index * every);
  if (rows.length === 0) return <p className={styles.empty}>{t(over ? "run.noWork" : "run.noWorkYet")}</p>;
  return (
    <div className={styles.timeline}>
      <MomentScale
        className={styles.scale}
        span_s={span_s}
        elapsed_s={elapsed_s}
        moment={comments.moment}
        onMoment={comments.setMoment}
        onWrite={comments.allowed ? onWrite : null}
      >
        {ticks.map((tick) => (
          <span key={tick} aria-hidden="true" style={{ left: `${(tick / span_s) * 100}%` }}>
            {clock(tick)}
          </span>
        ))}
      </MomentScale>
      <Commented comments={comments} span_s={span_s} />
      {rows.map((row) => {
        const device = devices.find((each) => each.id === row.device);
        return (
          <div key={row.device} className={styles.row}>
            <span className={styles.name}>
              <DeviceIcon deviceClass={device?.device_class ?? ""} size={16} /> {device?.name ?? row.device}
            </span>
            <div className={styles.lane}>
              {ticks.map((tick) => (
                <i key={tick} style={{ left: `${(tick / span_s) * 100}%` }} />
              ))}
              {row.bars.map((bar) => (
                <BarButton key={`${bar.step}-${bar.kind}-${bar.started_s}`} bar={bar} span_s={span_s} props={props} />
              ))}
              {over ? null : <em style={{ left: `${(elapsed_s / span_s) * 100}%` }} />}
              {comments.moment === null ? null : <s style={{ left: `${(comments.moment / span_s) * 100}%` }} />}
            </div>
          </div>
        );
      })}
    </div>
  );
}

/** A row with the pins of comments; none where nothing is open. */
function Commented({ comments, span_s }: { comments: RunComments; span_s: number }) {
  const { t } = useTranslation();
  if (comments.threads.every(({ thread }) => thread.resolved_at !== null)) return null;
  return (
    <div className={styles.row}>
      <span className={styles.name}>
        <MessageSquare size={15} aria-hidden="true" /> {t("comments.title")}
      </span>
      <div className={styles.lane}>
        <MomentPins comments={comments} span_s={span_s} />
      </div>
    </div>
  );
}

/** A row a device that worked, robots first. */
function useRows({ timeline, devices, robotOf }: TimelineProps) {
  const order = useMemo(
    () => [...devices].sort((a, b) => a.kind.localeCompare(b.kind) * -1 || a.name.localeCompare(b.name)),
    [devices],
  );
  return useMemo(
    () =>
      ganttOf(
        timeline.told,
        timeline.since,
        order.map((device) => device.id),
        robotOf,
      ),
    [timeline, order, robotOf],
  );
}

/** What the bars' looks mean. */
export function TimelineLegend() {
  const { t } = useTranslation();
  return (
    <ul className={styles.legend}>
      {["done", "running", "wait", "failed"].map((kind) => (
        <li key={kind}>
          <span className={styles.sample} data-kind={kind} aria-hidden="true" /> {t(`run.bar.${kind}`)}
        </li>
      ))}
    </ul>
  );
}
