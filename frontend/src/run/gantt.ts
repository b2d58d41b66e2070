/**
 * A run's timeline: who worked on which step, from when to when. Pure.
 *
 * The server reads journals in the same way (`execution/runs/timeline.py`); what it has told goes on here.
 */
import type { RunEvent, RunTimeline, TimelineBar } from "@/api/types";

export type Bar = TimelineBar;

export interface GanttRow {
  device: string;
  bars: Bar[];
}

const FAILED = new Set(["FAILED", "REJECTED"]);
/** Pieces of one way follow each other closely; a pause shorter than this does not part a bar. */
const JOIN_S = 3;

const keyOf = (device: string, step: string, kind: Bar["kind"]) => `${device} ${step} ${kind}`;

class Collector {
  readonly bars = new Map<string, Bar[]>();
  readonly #open = new Map<string, Bar>();

  constructor(told: readonly Bar[]) {
    for (const each of told) {
      const bar = { ...each };
      this.#rowOf(bar.device).push(bar);
      if (bar.ended_s === null) this.#open.set(keyOf(bar.device, bar.step, bar.kind), bar);
    }
  }

  #rowOf(device: string): Bar[] {
    const row = this.bars.get(device) ?? [];
    this.bars.set(device, row);
    return row;
  }

  /** A piece of work begins: it goes on with the device's last bar if that is of the same step and just over. */
  begin(device: string, step: string, kind: Bar["kind"], started_s: number): void {
    const key = keyOf(device, step, kind);
    const open = this.#open.get(key);
    if (open) {
      open.pending += 1;
      return;
    }
    const row = this.#rowOf(device);
    const last = row.at(-1);
    const fresh: Bar = { device, step, kind, started_s, ended_s: null, failed: false, count: 1, pending: 1 };
    const bar = last && goesOn(last, fresh) ? last : fresh;
    if (bar === fresh) row.push(bar);
    bar.ended_s = null;
    bar.pending = 1;
    this.#open.set(key, bar);
  }

  isOpen(device: string, step: string, kind: Bar["kind"]): boolean {
    return this.#open.has(keyOf(device, step, kind));
  }

  end(device: string, step: string, kind: Bar["kind"], at_s: number, failed = false): void {
    const key = keyOf(device, step, kind);
    const open = this.#open.get(key);
    if (!open) return;
    open.pending -= 1;
    open.failed ||= failed;
    if (open.pending > 0) return;
    open.ended_s = at_s;
    this.#open.delete(key);
  }

  /** A step was broken off: whatever was done for it is over, and did not come to its end. */
  breakOff(step: string, at_s: number): void {
    for (const [key, bar] of [...this.#open]) {
      if (bar.step !== step) continue;
      bar.ended_s = at_s;
      bar.failed = bar.kind === "work";
      this.#open.delete(key);
    }
  }
}

function goesOn(last: Bar, next: Bar): boolean {
  const isSame = last.step === next.step && last.kind === next.kind && !last.failed;
  return isSame && last.ended_s !== null && next.started_s - last.ended_s < JOIN_S;
}

/** Which robot a step's role is bound to, if it is known. */
export type RobotOf = (step: string) => string | undefined;

class Reader {
  readonly collector: Collector;
  /** Steps under way, the one that began last at the end. */
  #steps: string[];
  /** The step that each driving robot drives for. */
  readonly #drives: Map<string, string>;

  constructor(
    told: RunTimeline,
    readonly robotOf: RobotOf,
  ) {
    this.collector = new Collector(told.bars);
    this.#steps = [...told.steps];
    this.#drives = new Map(Object.entries(told.drives));
  }

  take(event: RunEvent): void {
    const who = event.robot || event.device;
    if (event.kind === "step") this.#noteStep(event);
    else if (event.code === "way") this.#drive(event.robot, event.t_s);
    else if (event.code === "command") {
      this.#arrive(event.device, event.t_s);
      this.collector.begin(event.device, event.step, "work", event.t_s);
    } else if (event.code === "answer") {
      this.collector.end(event.device, event.step, "work", event.t_s, FAILED.has(String(event.args.status)));
    } else if (event.kind === "wait" && who) this.#noteWait(event, who);
  }

  #noteWait(event: RunEvent, who: string): void {
    if (event.code === "wait_over") this.collector.end(who, event.step, "wait", event.t_s);
    // Else it is only told anew for what it waits.
    else if (!this.collector.isOpen(who, event.step, "wait")) this.collector.begin(who, event.step, "wait", event.t_s);
  }

  #noteStep(event: RunEvent): void {
    if (event.code === "step_entered") this.#steps.push(event.step);
    else if (event.code.startsWith("step_")) this.#leave(event); // others tell how it goes on
  }

  #leave(event: RunEvent): void {
    this.#steps = this.#steps.filter((step) => step !== event.step);
    if (event.code !== "step_done") this.collector.breakOff(event.step, event.t_s);
    for (const [robot, step] of [...this.#drives]) if (step === event.step) this.#arrive(robot, event.t_s);
  }

  #drive(robot: string, at_s: number): void {
    const step = this.#steps.filter((each) => this.robotOf(each) === robot).at(-1) ?? "";
    if (this.#drives.get(robot) === step) return;
    this.#arrive(robot, at_s);
    this.#drives.set(robot, step);
    this.collector.begin(robot, step, "work", at_s);
  }

  #arrive(robot: string, at_s: number): void {
    const step = this.#drives.get(robot);
    if (step === undefined) return;
    this.collector.end(robot, step, "work", at_s);
    this.#drives.delete(robot);
  }
}

/**
 * What a timeline has told and what the journal has told since, as rows in the order of `devices` (robots first, as the
 * caller gives them); devices without a bar are left out.
 */
export function ganttOf(
  told: RunTimeline,
  since: readonly RunEvent[],
  devices: readonly string[],
  robotOf: RobotOf,
): GanttRow[] {
  const reader = new Reader(told, robotOf);
  for (const event of since) reader.take(event);
  const { bars } = reader.collector;
  const known = devices.filter((device) => bars.has(device));
  const others = [...bars.keys()].filter((device) => !known.includes(device)).sort();
  return [...known, ...others].map((device) => ({ device, bars: bars.get(device) ?? [] }));
}
