/** The run's events as bars: who worked on which step, from when to when. Pure. */
import type { RunEvent } from "@/api/types";

export type BarKind = "work" | "wait";

export interface Bar {
  device: string;
  step: string;
  kind: BarKind;
  started_s: number;
  /** Null while it goes on. */
  ended_s: number | null;
  failed: boolean;
}

export interface GanttRow {
  device: string;
  bars: Bar[];
}

const FAILED = new Set(["FAILED", "REJECTED"]);
/** Pieces of one way follow each other closely; a pause shorter than this does not part a bar. */
const JOIN_S = 3;

interface Open {
  bar: Bar;
  pending: number;
}

class Collector {
  readonly bars = new Map<string, Bar[]>();
  readonly #open = new Map<string, Open>();

  /** A piece of work begins: it goes on with the device's last bar if that is of the same step and just over. */
  begin(device: string, step: string, kind: BarKind, at_s: number): void {
    const key = `${device} ${step} ${kind}`;
    const open = this.#open.get(key);
    if (open) {
      open.pending += 1;
      return;
    }
    const row = this.bars.get(device) ?? [];
    const last = row[row.length - 1];
    const goesOn =
      last?.step === step &&
      last.kind === kind &&
      !last.failed &&
      last.ended_s !== null &&
      at_s - last.ended_s < JOIN_S;
    const bar: Bar = goesOn && last ? last : { device, step, kind, started_s: at_s, ended_s: null, failed: false };
    bar.ended_s = null;
    if (bar !== last) row.push(bar);
    this.bars.set(device, row);
    this.#open.set(key, { bar, pending: 1 });
  }

  end(device: string, step: string, kind: BarKind, at_s: number, failed = false): void {
    const key = `${device} ${step} ${kind}`;
    const open = this.#open.get(key);
    if (!open) return;
    open.pending -= 1;
    open.bar.failed ||= failed;
    if (open.pending > 0) return;
    open.bar.ended_s = at_s;
    this.#open.delete(key);
  }

  /** A step was broken off: whatever was done for it is over, and did not come to its end. */
  breakOff(step: string, at_s: number): void {
    for (const [key, { bar }] of [...this.#open]) {
      if (bar.step !== step) continue;
      bar.ended_s = at_s;
      bar.failed = bar.kind === "work";
      this.#open.delete(key);
    }
  }
}

/** Which robot a step's role is bound to, if it is known. */
export type RobotOf = (step: string) => string | undefined;

class Reader {
  readonly collector = new Collector();
  /** Steps under way, the one that began last at the end. */
  #steps: string[] = [];
  /** The step that each driving robot drives for. */
  readonly #drives = new Map<string, string>();

  constructor(readonly robotOf: RobotOf) {}

  take(event: RunEvent): void {
    const who = event.robot || event.device;
    if (event.code === "step_entered") this.#steps.push(event.step);
    else if (event.kind === "step") this.#leave(event);
    else if (event.code === "way") this.#drive(event.robot, event.t_s);
    else if (event.code === "command") {
      this.#arrive(event.device, event.t_s);
      this.collector.begin(event.device, event.step, "work", event.t_s);
    } else if (event.code === "answer") {
      this.collector.end(event.device, event.step, "work", event.t_s, FAILED.has(String(event.args.status)));
    } else if (event.code === "wait_over" && who) this.collector.end(who, event.step, "wait", event.t_s);
    else if (event.kind === "wait" && who) this.collector.begin(who, event.step, "wait", event.t_s);
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

/** Rows in the order of `devices` (robots first, as the caller gives them); devices without a bar are left out. */
export function ganttOf(events: readonly RunEvent[], devices: readonly string[], robotOf: RobotOf): GanttRow[] {
  const reader = new Reader(robotOf);
  for (const event of events) reader.take(event);
  const { bars } = reader.collector;
  const known = devices.filter((device) => bars.has(device));
  const others = [...bars.keys()].filter((device) => !known.includes(device)).sort();
  return [...known, ...others].map((device) => ({ device, bars: bars.get(device) ?? [] }));
}
