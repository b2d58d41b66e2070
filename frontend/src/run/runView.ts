/** All that the parts of a run's screen show of it. */
import { useEffect, useMemo, useState } from "react";
import { useDevices, useSiteMap } from "@/api/queries";
import { type GrowingTimeline, useRunTimeline } from "@/api/runs";
import { mayOperate } from "@/api/roles";
import type { Device, Run, Site } from "@/api/types";
import { useAsHeld } from "@/live/held";
import { type AboutMoment, useRunComments } from "./comments/useRunComments";
import { isSimulated } from "./RunSteps";
import { useJournalLines } from "./journalLines";
import { stepAt, stepLines } from "./stepList";
import { useStepWords } from "./useStepWords";

export const OVER = ["finished", "failed", "cancelled"];
export type Tab = "timeline" | "logs" | "script" | "comments";

export interface LoadedProps {
  run: Run;
  site: Site | undefined;
}

const NO_DEVICES: Device[] = [];
const NO_TIMELINE: GrowingTimeline = {
  told: { seq: 0, bars: [], steps: [], drives: {}, simulated: [] },
  since: [],
};
const MOST_LABEL = 120;

/** The present moment, once a second while it matters. */
function useNow(running: boolean): number {
  const [now, setNow] = useState(Date.now);
  useEffect(() => {
    if (!running) return;
    const timer = setInterval(() => setNow(Date.now()), 1000);
    return () => clearInterval(timer);
  }, [running]);
  return now;
}

export function elapsedSeconds(run: Run, now: number): number {
  if (!run.started_at) return 0;
  const end = run.ended_at ? Date.parse(run.ended_at) : now;
  return Math.max(0, (end - Date.parse(run.started_at)) / 1000);
}

function momentOfRun(run: Run, t_s: number): number {
  return Date.parse(run.started_at ?? run.created_at) + t_s * 1000;
}

/** All that the parts of the screen show of a run. */
export function useRunView({ run, site }: LoadedProps) {
  const devices = useAsHeld(useDevices(run.site).data) ?? NO_DEVICES;
  const map = useSiteMap(run.site).data ?? null;
  const journal = useJournalLines(run.id);
  const timeline = useRunTimeline(run.id).data ?? NO_TIMELINE;
  const over = OVER.includes(run.status);
  const now = useNow(!over);
  const [selected, setSelected] = useState<string | null>(null);
  const simulated = useMemo(() => {
    const since = timeline.since.filter(isSimulated).map((event) => event.device);
    return new Set([...timeline.told.simulated, ...since]);
  }, [timeline]);
  const lines = useMemo(() => stepLines(run.compiled, run.steps), [run.compiled, run.steps]);
  const numberOf = (step: string) => run.compiled.numbers[step] ?? "";
  const nameOf = (id: string) => devices.find((device) => device.id === id)?.name ?? id;
  const comments = useRunComments(run, site);
  const [tab, setTab] = useState<Tab>(comments.opened === null ? "timeline" : "comments");
  const words = useStepWords(run.document, devices, map?.places);
  /** What is begun to be written about a moment: with the step that was carried out then. */
  const aboutMoment = (t_s: number, of = stepAt(lines, momentOfRun(run, t_s))): AboutMoment => {
    const label = of ? words.titleOf(of).slice(0, MOST_LABEL) : "";
    return { t_s, label };
  };
  const write = (about: AboutMoment) => {
    comments.setMoment(about.t_s);
    comments.setWriting(about);
    setTab("comments");
  };
  const allowed = site !== undefined && mayOperate(site.role);
  return {
    run,
    site,
    devices,
    map,
    journal,
    timeline,
    over,
    now,
    selected,
    setSelected,
    lines,
    numberOf,
    nameOf,
    simulated,
    allowed,
    comments,
    words,
    tab,
    setTab,
    aboutMoment,
    write,
  };
}

export type RunView = ReturnType<typeof useRunView>;
