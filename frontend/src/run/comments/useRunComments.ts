/** What of a run's comments is on one person's screen: the chosen moment, the form and the thread that are open. */
import { useCallback, useMemo, useState } from "react";
import { useSearchParams } from "react-router-dom";
import { ApiProblem } from "@/api/client";
import { mayComment } from "@/api/roles";
import type { Run, Site } from "@/api/types";
import { threadsOfRun } from "@/shell/comments/moments";
import { useCommentOnRun, useThreads } from "@/shell/comments/threads";

export interface AboutMoment {
  /** Seconds after the run's start. */
  readonly t_s: number;
  /** What happens then, in words. */
  readonly label: string;
}

const THREAD = "thread";

export function useRunComments(run: Run, site: Site | undefined) {
  const query = useThreads(run.program.id);
  const threads = useMemo(() => threadsOfRun(query.data ?? [], run.id), [query.data, run.id]);
  const begin = useCommentOnRun(run.program.id, run.id);
  const isGone = query.error instanceof ApiProblem && query.error.status === 404;
  const [parameters, setParameters] = useSearchParams();
  const [chosen, setMoment] = useState<number | null>(null);
  const [writing, setWriting] = useState<AboutMoment | null>(null);
  const opened = parameters.get(THREAD);
  const open = useCallback(
    (thread: string | null) => {
      setMoment(null);
      setParameters(
        (before) => {
          const after = new URLSearchParams(before);
          if (thread === null) after.delete(THREAD);
          else after.set(THREAD, thread);
          return after;
        },
        { replace: true },
      );
    },
    [setParameters],
  );
  return {
    query,
    threads,
    /** Seconds after the start: what was chosen, else that of the opened thread. */
    moment: chosen ?? threads.find(({ thread }) => thread.id === opened)?.t_s ?? null,
    setMoment,
    writing,
    setWriting,
    opened,
    open,
    begin,
    /** They go with their program. */
    isGone,
    allowed: !isGone && run.started_at !== null && mayComment(site?.role),
  };
}

export type RunComments = ReturnType<typeof useRunComments>;
