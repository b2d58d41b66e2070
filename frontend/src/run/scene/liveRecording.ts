/** What devices do now, kept as a recording of the last minutes, so that it is drawn as a rehearsal is. */
import type { PoseFrame } from "@/scene3d/frames";
import type { Moment, SceneRecording } from "@/scene3d/types";
import { ownEntry } from "@/design/ownEntry";

/** How devices are at a moment, by their ids: metres, radians; of robots what they carry and where they are going. */
export interface Seen {
  readonly robots: Readonly<Record<string, SeenRobot>>;
  /** Whether a machine is at work. */
  readonly machines: Readonly<Record<string, boolean>>;
}

export interface SeenRobot {
  readonly pose: PoseFrame;
  readonly carrying: Readonly<Record<string, number>>;
  readonly route: readonly (readonly [number, number])[];
}

export const EVERY_S = 0.1;
/** So much is kept at least; what is older is let go in pieces of as much. */
const KEPT_S = 120;
/** Longer than poses come apart from each other. */
const LIVELY_S = 2;

/** By reference first: what has not changed is mostly the same object. */
const same = (a: unknown, b: unknown) => a === b || JSON.stringify(a) === JSON.stringify(b);

const empty = (): SceneRecording => ({
  frames: { dt_s: EVERY_S, robots: {} },
  carrying: {},
  machine_states: {},
  routes: {},
});

export class LiveRecording {
  /** Changed in place; whoever draws it looks at it anew in each frame. */
  readonly recording: SceneRecording = empty();
  /** The moment that is shown, in seconds of the recording. */
  readonly moment: Moment = { t_s: 0 };
  private begun_s: number | null = null;
  private changed_s = -Infinity;

  /** Show the moment `now_s`, a little late, so that there are poses on both sides of it. */
  show(now_s: number): void {
    if (this.begun_s !== null) this.moment.t_s = Math.max(0, now_s - this.begun_s - EVERY_S);
  }

  /** Whether anything was different in the last moments before `now_s`, so that pictures of them differ. */
  isLively(now_s: number): boolean {
    return now_s - this.changed_s < LIVELY_S;
  }

  /** Keep how devices are at `now_s`; what was not seen meanwhile stood as it had been. */
  see(now_s: number, seen: Seen): void {
    if (this.begun_s === null || now_s - this.begun_s > 3 * KEPT_S) this.beginAnew(now_s);
    const t_s = now_s - (this.begun_s ?? now_s);
    const last = Math.floor(t_s / EVERY_S + 1e-6);
    const robots = Object.entries(seen.robots).map(([id, robot]) => this.seeRobot(id, robot, t_s, last));
    const { machine_states } = this.recording;
    const machines = Object.entries(seen.machines).map(([id, busy]) => note(machine_states, id, t_s, busy));
    if ([...robots, ...machines].some(Boolean)) this.changed_s = now_s;
    if (t_s > 2 * KEPT_S) this.forget(KEPT_S);
  }

  private seeRobot(id: string, { pose, carrying, route }: SeenRobot, t_s: number, last: number): boolean {
    const { robots } = this.recording.frames;
    const poses = (robots[id] = ownEntry(robots, id) ?? []);
    const before = poses.at(-1) ?? pose;
    while (poses.length < last) poses.push(before);
    poses[last] = pose;
    const { carrying: loads, routes } = this.recording;
    const noted = [note(loads, id, t_s, carrying), note(routes, id, t_s, route)];
    return noted.some(Boolean) || before.some((value, axis) => value !== pose[axis]);
  }

  private beginAnew(now_s: number): void {
    this.begun_s = now_s;
    Object.assign(this.recording, empty());
  }

  /** Let the first `seconds` go; what was so before still is. */
  private forget(seconds: number): void {
    const { frames, carrying, machine_states, routes } = this.recording;
    const noted: Record<string, [number, unknown][]>[] = [carrying, machine_states, routes];
    const frames_gone = Math.round(seconds / EVERY_S);
    for (const poses of Object.values(frames.robots)) poses.splice(0, Math.min(frames_gone, poses.length - 1));
    for (const notes of noted.flatMap((each) => Object.values(each))) {
      const current = notes.findLastIndex(([at]) => at <= seconds);
      notes.splice(0, Math.max(0, current));
      for (const each of notes) each[0] = Math.max(0, each[0] - seconds);
    }
    this.begun_s = (this.begun_s ?? 0) + seconds;
    this.moment.t_s = Math.max(0, this.moment.t_s - seconds);
  }
}

function note<T>(notes: Record<string, [number, T][]>, id: string, t_s: number, value: T): boolean {
  const list = (notes[id] = ownEntry(notes, id) ?? []);
  if (list.length > 0 && same(list.at(-1)?.[1], value)) return false;
  list.push([t_s, value]);
  return true;
}
