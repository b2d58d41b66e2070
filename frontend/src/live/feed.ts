/** Writes what a site's socket says into the query caches and the live store. */
import { notifications } from "@mantine/notifications";
import type { Query, QueryClient, QueryKey } from "@tanstack/react-query";
import i18next from "i18next";
import { keys } from "@/api/queries";
import { mapKeys, staleWithSiteMap } from "@/api/robotMaps";
import type { GrowingTimeline, NewestRuns, RunJournal } from "@/api/runs";
import type {
  Alert,
  ArmedProgram,
  Device,
  Program,
  Question,
  Rehearsal,
  RehearsalSummary,
  Run,
  RunEvent,
  RunSummary,
  Site,
  SiteStop,
  VersionRuns,
} from "@/api/types";
import { ownEntry } from "@/design/ownEntry";
import { applyAlert } from "./alerts";
import { LiveCaches } from "./caches";
import {
  applyChanges,
  applyChecked,
  applyJournalLine,
  applyOpenRun,
  applyQuestion,
  applyRehearsal,
  applyRun,
  applyTimelineLine,
  isOpen,
  isOver,
  isUrgent,
  joinChanges,
} from "./messages";
import type { DeviceChange, LiveMessage, RobotTraffic } from "./messages";
import { recordDevice } from "./readings";
import { isLookedAt, setLive, useLiveStore } from "./store";

const SLOW_MS = 1000;
const FAST_MS = 150;
const NOTICES_KEPT = 50;
/** Of what a device tells, where it is and what it reads are all the time; a change of one of these makes history. */
const IN_HISTORY: readonly (keyof Device)[] = ["status", "lifecycle", "name", "methods", "stand_in", "has_key"];

export class SiteFeed {
  readonly #changes = new Map<string, DeviceChange>();
  #timer: ReturnType<typeof setTimeout> | undefined;
  #dueAt = Infinity;
  #isGreeted = false;
  readonly #since = Date.now();
  readonly #caches: LiveCaches;

  constructor(
    private readonly slug: string,
    private readonly queries: QueryClient,
  ) {
    this.#caches = new LiveCaches(queries);
  }

  take(message: LiveMessage): void {
    switch (message.type) {
      case "hello":
        return this.#refresh();
      case "beat":
        return;
      case "device":
        return this.#device(message.device);
      case "device_removed":
        return this.#removed(message.id);
      case "map":
        return this.#refreshAll(staleWithSiteMap(this.slug));
      case "obstacles":
        return this.#caches.refresh(keys.map(this.slug));
      case "robot_map":
        return this.#robotMap(message.device);
      case "run":
        return this.#run(message.run);
      case "run_event":
        return this.#runEvent(message.run, message.event);
      case "question":
        return this.#question(message.question);
      case "notice":
        return this.#notice(message);
      case "alert":
        return this.#alert(message.alert);
      case "alerts":
        return this.#caches.refresh(keys.alerts(this.slug));
      case "armed":
        return this.#caches.write<ArmedProgram[]>(keys.armed(this.slug), () => message.programs);
      case "rehearsal":
        return this.#rehearsal(message);
      case "stop":
        return this.#stop({ active: message.active, by: message.by, at: message.at });
      case "traffic":
        return this.#traffic(message.robots);
      case "copies":
        return setLive(this.slug, { copies: Object.fromEntries(message.copies.map((copy) => [copy.device, copy])) });
      case "measured":
        for (const device of message.devices) this.#caches.refresh(keys.paces(this.slug, device));
        return this.#caches.refresh(["measurements"]);
      case "programs":
        this.#caches.refresh(["program"]); // a name, also where it is open
        return this.#caches.refresh(keys.programs(this.slug));
      case "comments":
        return this.#caches.refresh(keys.threads(message.program));
      case "tests":
        return this.#caches.refresh(keys.tests(message.program));
      case "review":
        this.#caches.refresh(keys.setting(this.slug, "review-rule"));
        return this.#caches.refresh(keys.reviews);
      case "role":
        notifications.show({
          message: i18next.t("role.now", { role: i18next.t(`role.${message.role}`) }),
        });
        return this.#siteChanged();
      case "checked":
        this.#caches.refresh(keys.comparison(message.program));
        this.#caches.refresh(keys.reviews);
        return this.#caches.write<Program[]>(keys.programs(this.slug), (programs) => applyChecked(programs, message));
    }
  }

  end(): void {
    clearTimeout(this.#timer);
    this.#caches.end();
  }

  /** After each (new) greeting the state is fetched anew: what happened meanwhile was missed. */
  #refresh(): void {
    setLive(this.slug, { traffic: {}, copies: {} }); // all of them are told again within seconds
    const stale = [
      keys.devices,
      keys.site,
      keys.map,
      keys.runs,
      keys.programs,
      keys.questions,
      keys.admissions,
      keys.armed,
      keys.alerts,
    ].map((key) => key(this.slug) as readonly string[]);
    const open = [
      "threads",
      "tests",
      "run",
      "run-events",
      "run-timeline",
      "rehearsal",
      "robot-map",
      "map-difference",
      "map-versions",
    ].map((name) => [name]);
    this.#refreshAll([...stale, ...open]);
    this.#refreshMore();
    this.#isGreeted = true;
  }

  /**
   * What else the news are about. What was fetched since this feed began, or just is, is left alone at the first
   * greeting: a page that has just opened has it fresh.
   */
  #refreshMore(): void {
    const isOld = ({ state }: Query) => state.fetchStatus === "idle" && state.dataUpdatedAt < this.#since;
    const ofSite = [keys.overAlerts(this.slug), keys.rehearsals(this.slug), keys.setting(this.slug, "review-rule")];
    const all = [
      ...ofSite,
      ["paces", this.slug],
      ["device-events", this.slug],
      ["measurements"],
      ["comparison"],
      ["program"],
      keys.reviews,
      keys.sites,
    ];
    for (const key of all) this.#caches.refresh(key, this.#isGreeted ? undefined : isOld);
  }

  #device(change: DeviceChange): void {
    if (isLookedAt(this.slug)) recordDevice(change, performance.now());
    const before = ownEntry(useLiveStore.getState().deviceById, change.id);
    this.#changes.set(change.id, joinChanges(this.#changes.get(change.id), change));
    this.#flushIn(isUrgent(before, change) ? FAST_MS : SLOW_MS);
  }

  #flushIn(wait_ms: number): void {
    const due = performance.now() + wait_ms;
    if (due >= this.#dueAt) return;
    clearTimeout(this.#timer);
    this.#dueAt = due;
    this.#timer = setTimeout(() => this.#flush(), wait_ms);
  }

  #flush(): void {
    this.#dueAt = Infinity;
    const key = keys.devices(this.slug);
    const changes = new Map(this.#changes);
    this.#changes.clear();
    const { strangers } = applyChanges(this.queries.getQueryData<Device[]>(key) ?? [], changes);
    const news = [...changes.values()].filter((change) => IN_HISTORY.some((key) => key in change));
    this.#caches.write<Device[]>(key, (devices) => applyChanges(devices, changes).devices);
    if (strangers.length > 0) this.#caches.refresh(key);
    for (const { id } of news) this.#caches.refresh(keys.deviceEvents(this.slug, id));
    if (strangers.length > 0 || news.length > 0) this.#siteChanged();
  }

  #siteChanged(): void {
    this.#refreshAll([keys.site(this.slug), keys.sites]);
  }

  #refreshAll(stale: readonly QueryKey[]): void {
    for (const queryKey of stale) this.#caches.refresh(queryKey);
  }

  #removed(id: string): void {
    this.#caches.write<Device[]>(keys.devices(this.slug), (all) => all.filter((each) => each.id !== id));
    this.#siteChanged();
  }

  #robotMap(device: string): void {
    this.#refreshAll([mapKeys.robot(this.slug, device), mapKeys.difference(this.slug, device)]);
  }

  #run(run: RunSummary): void {
    this.#caches.write<NewestRuns>(keys.runs(this.slug), (newest) => ({ ...newest, runs: applyRun(newest.runs, run) }));
    this.#caches.write<RunSummary[]>(keys.openRuns(this.slug), (runs) => applyOpenRun(runs, run));
    this.#caches.write<Run>(keys.run(run.id), (full) => ({ ...full, ...run }));
    if (run.status === "pending" || !isOpen(run) || this.#isShownOtherwise(run))
      this.#caches.refresh(keys.versionRuns(this.slug, run.program.id));
  }

  /** Whether a version's newest runs tell another state of one. */
  #isShownOtherwise({ id, status, program }: RunSummary): boolean {
    const queryKey = keys.versionRuns(this.slug, program.id);
    const newest = this.queries.getQueriesData<VersionRuns[]>({ queryKey }).flatMap(([, versions]) => versions ?? []);
    return newest.some(({ newest }) => newest.some((each) => each.id === id && each.status !== status));
  }

  #runEvent(run: string, event: RunEvent): void {
    this.#caches.write<RunJournal>(keys.runEvents(run), (journal) => applyJournalLine(journal, event));
    this.#caches.write<GrowingTimeline>(keys.runTimeline(run), (timeline) => applyTimelineLine(timeline, event));
  }

  #traffic(robots: Readonly<Record<string, RobotTraffic>>): void {
    const known = useLiveStore.getState().traffic;
    setLive(this.slug, { traffic: { ...known, ...robots } });
    const waits = (robot: RobotTraffic | undefined) => robot?.why?.code === "not_let_in";
    if (Object.entries(robots).some(([id, robot]) => waits(robot) !== waits(ownEntry(known, id))))
      this.#caches.refresh(keys.admissions(this.slug));
  }

  #question(question: Question): void {
    this.#caches.write<Question[]>(keys.questions(this.slug), (all) => applyQuestion(all, question));
  }

  #alert(alert: Alert): void {
    this.#caches.write<Alert[]>(keys.alerts(this.slug), (all) => applyAlert(all, alert));
    if (alert.state === "over") this.#caches.refresh(keys.overAlerts(this.slug));
  }

  #notice({ run, text, level, code = "", args = {} }: Extract<LiveMessage, { type: "notice" }>): void {
    const { notices } = useLiveStore.getState();
    const id = (notices.at(-1)?.id ?? 0) + 1;
    setLive(this.slug, { notices: [...notices.slice(1 - NOTICES_KEPT), { id, run, text, level, code, args }] });
  }

  #rehearsal(message: Extract<LiveMessage, { type: "rehearsal" }>): void {
    const key = keys.rehearsal(message.id);
    this.#caches.write<Rehearsal>(key, (old) => applyRehearsal(old, message));
    if (isOver(message.status)) this.#caches.refresh(key);
    this.#caches.write<RehearsalSummary[]>(keys.rehearsals(this.slug), (all) =>
      all.map((each) => (each.id === message.id ? applyRehearsal(each, message) : each)),
    );
  }

  #stop(stop: SiteStop): void {
    setLive(this.slug, { stop });
    this.#caches.write<Site>(keys.site(this.slug), (site) => ({ ...site, stop }));
  }
}
