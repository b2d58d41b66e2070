/** What `/ws/site/<slug>` says, and how a device changes by it; pure. */
import type { GrowingTimeline, RunJournal } from "@/api/runs";
import type {
  Alert,
  ArmedProgram,
  Device,
  Point,
  Program,
  Question,
  RehearsalCourse,
  RehearsalStatus,
  RunEvent,
  Role,
  RunSummary,
  SiteStop,
  WaitReason,
} from "@/api/types";

/** Where a robot is about to drive, metres. */
export interface RobotTraffic {
  route: Point[];
  /** The piece of it that is its own. */
  reserved: Point[];
  wait: string | null;
  why?: WaitReason | null;
}

/** Where the mirror's copy of a robot is (metres, radians). */
export interface CopyPose {
  device: string;
  x: number;
  y: number;
  theta: number;
}

export type DeviceChange = Partial<Device> & { id: string };

export type LiveMessage =
  | { type: "hello"; site: string }
  | { type: "beat" }
  | { type: "device"; device: DeviceChange }
  | { type: "device_removed"; id: string }
  | { type: "map"; version: number }
  | { type: "obstacles" }
  | { type: "robot_map"; device: string; version: number }
  | { type: "run"; run: RunSummary }
  | { type: "run_event"; run: string; event: RunEvent }
  | { type: "question"; question: Question }
  | {
      type: "notice";
      run: string;
      text: string;
      level: "info" | "warning";
      code?: string;
      args?: Readonly<Record<string, unknown>>;
    }
  | { type: "alert"; alert: Alert }
  | { type: "alerts" }
  | { type: "armed"; programs: ArmedProgram[] }
  | ({ type: "rehearsal" } & RehearsalNews)
  | ({ type: "stop" } & SiteStop)
  | { type: "traffic"; robots: Record<string, RobotTraffic> }
  | { type: "copies"; copies: CopyPose[] }
  | { type: "measured"; devices: string[] }
  | { type: "programs" }
  | { type: "comments"; program: string }
  | { type: "tests"; program: string }
  | { type: "review" }
  | { type: "role"; role: Role }
  | ({ type: "checked" } & CheckedProgram);

/** How a rehearsal stands now. */
export interface RehearsalNews {
  id: string;
  status: RehearsalStatus;
  progress: number;
  course: RehearsalCourse | null;
  /** How often it was begun. */
  tries: number;
}

/** Whether nothing more comes of a rehearsal. */
export function isOver(status: RehearsalStatus): boolean {
  return status !== "queued" && status !== "running";
}

/** A rehearsal with what was told of it; what was overtaken on its way does not turn it back. */
export function applyRehearsal<R extends Omit<RehearsalNews, "id">>(rehearsal: R, news: RehearsalNews): R {
  const { status, progress, course, tries } = news;
  const overtaken = tries === rehearsal.tries && status === rehearsal.status && progress < rehearsal.progress;
  return overtaken ? rehearsal : { ...rehearsal, status, progress, course, tries };
}

/** What lists show of a program that was checked. */
export interface CheckedProgram {
  program: string;
  revision: number;
  shown: Pick<Program, "kinds" | "devices" | "places" | "edited_at" | "edited_by" | "errors" | "warnings">;
}

/** The list of programs with what it is to show of one that was checked. */
export function applyChecked(programs: readonly Program[], checked: CheckedProgram): Program[] {
  const { program, shown } = checked;
  return programs.map((each) => (each.id === program ? { ...each, ...shown } : each));
}

/** Changes that people must see at once; the rest (poses, readings) may be gathered. */
const URGENT: readonly (keyof Device)[] = ["status", "doing", "activity", "lifecycle", "carrying", "name", "done"];

export function isUrgent(before: Device | undefined, change: DeviceChange): boolean {
  if (!before) return true;
  return URGENT.some((key) => key in change && JSON.stringify(change[key]) !== JSON.stringify(before[key]));
}

/** Two changes of one device as one. */
export function joinChanges(first: DeviceChange | undefined, second: DeviceChange): DeviceChange {
  return first ? { ...first, ...second } : second;
}

/** Put changes into a list of devices; a change of a device that is not there is left out and named. */
export function applyChanges(
  devices: readonly Device[],
  changes: ReadonlyMap<string, DeviceChange>,
): { devices: Device[]; strangers: string[] } {
  const known = new Set(devices.map((device) => device.id));
  return {
    devices: devices.map((device) => {
      const change = changes.get(device.id);
      return change ? { ...device, ...change } : device;
    }),
    strangers: [...changes.keys()].filter((id) => !known.has(id)),
  };
}

/** Put a run into a list, newest first. */
export function applyRun(runs: readonly RunSummary[], run: RunSummary): RunSummary[] {
  const rest = runs.filter((each) => each.id !== run.id);
  return [...rest, run].sort((a, b) => b.number - a.number);
}

/** Whether a run is not over: it is planned, waits, runs or is paused. */
export function isOpen({ status }: RunSummary): boolean {
  return status === "pending" || status === "running" || status === "paused";
}

/** The same for a list of the runs that are not over: one that is goes. */
export function applyOpenRun(runs: readonly RunSummary[], run: RunSummary): RunSummary[] {
  return applyRun(runs, run).filter(isOpen);
}

/** Add an event to a run's journal unless it is there already; by its number. */
export function applyRunEvent<E extends readonly RunEvent[]>(events: E, event: RunEvent): E | RunEvent[] {
  if ((events.at(-1)?.seq ?? 0) < event.seq) return [...events, event]; // as nearly always, and there may be thousands
  if (events.some((each) => each.seq === event.seq)) return events;
  return [...events, event].sort((a, b) => a.seq - b.seq);
}

/** The same for a journal of which there are parts: what is older than the newest part has its place in another. */
export function applyJournalLine(journal: RunJournal, event: RunEvent): RunJournal {
  const [newest, ...older] = journal.pages;
  if (!newest || (newest.next !== undefined && event.seq < (newest.items[0]?.seq ?? 0))) return journal;
  const items = applyRunEvent(newest.items, event);
  return items === newest.items ? journal : { ...journal, pages: [{ ...newest, items }, ...older] };
}

/** The same for a timeline, which has all up to a line. */
export function applyTimelineLine(timeline: GrowingTimeline, event: RunEvent): GrowingTimeline {
  if (event.seq <= timeline.told.seq) return timeline;
  return { ...timeline, since: applyRunEvent(timeline.since, event) };
}

/** Put a question into a list, in the order in which they were asked; one that is known is replaced. */
export function applyQuestion(questions: readonly Question[], question: Question): Question[] {
  const rest = questions.filter((each) => each.id !== question.id);
  return [...rest, question].sort((a, b) => a.asked_at.localeCompare(b.asked_at));
}
