/** Comments on a moment of a run: which, in what words, and where it is looked at. */
import type { Thread } from "@/api/types";
import { clock } from "@/design/clock";

export interface Moment {
  readonly run: string;
  /** The run's number at its site. */
  readonly number: number;
  /** Seconds after the run's start. */
  readonly t_s: number;
}

/** The moment that a thread is about; null if it is about something else. */
export function momentOf({ anchor }: Pick<Thread, "anchor">): Moment | null {
  const { kind, run, number, t_s } = anchor;
  return kind === "moment" && run !== null && number !== null && t_s !== null ? { run, number, t_s } : null;
}

/** The address of a run at which a thread is opened. */
export function momentPath({ run }: Moment, thread: string): string {
  return `/runs/${run}?${new URLSearchParams({ thread })}`;
}

type Translate = (key: string, values: Record<string, string | number>) => string;

/** `Run 12 at 0:34 · 2 Paint`, with what its writer called it, if anything. */
export function momentWords(t: Translate, { number, t_s }: Moment, label: string): string {
  return [t("comments.moment", { number, at: clock(t_s) }), label].filter(Boolean).join(" · ");
}

/** The threads about moments of a run, in the order of the moments. */
export function threadsOfRun(threads: readonly Thread[], run: string): { thread: Thread; t_s: number }[] {
  return threads
    .flatMap((thread) => {
      const moment = momentOf(thread);
      return moment?.run === run ? [{ thread, t_s: moment.t_s }] : [];
    })
    .sort((one, other) => one.t_s - other.t_s || one.thread.started_at.localeCompare(other.thread.started_at));
}
