/** Writes what a site's socket says into the query caches and the live store. */
import type { QueryClient } from "@tanstack/react-query";
import { keys } from "@/api/queries";
import { forgetSiteMap, mapKeys } from "@/api/robotMaps";
import type {
  Alert,
  ArmedProgram,
  Device,
  Question,
  Rehearsal,
  Run,
  RunEvent,
  RunSummary,
  Site,
  SiteStop,
} from "@/api/types";
import { applyAlert } from "./alerts";
import { applyChanges, applyQuestion, applyRun, applyRunEvent, isUrgent, joinChanges } from "./messages";
import type { DeviceChange, LiveMessage } from "./messages";
import { recordDevice } from "./readings";
import { useLiveStore } from "./store";

const SLOW_MS = 1000;
const FAST_MS = 150;
const NOTICES_KEPT = 50;

export class SiteFeed {
  readonly #changes = new Map<string, DeviceChange>();
  #timer: ReturnType<typeof setTimeout> | undefined;
  #dueAt = Infinity;

  constructor(
    private readonly slug: string,
    private readonly queries: QueryClient,
  ) {}

  take(message: LiveMessage): void {
    switch (message.type) {
      case "hello":
        return this.#refresh();
      case "device":
        return this.#device(message.device);
      case "device_removed":
        return this.#removed(message.id);
      case "map":
        return forgetSiteMap(this.queries, this.slug);
      case "robot_map":
        return this.#robotMap(message.device);
      case "compiled":
        return this.#compiled(message);
      case "run":
        return this.#run(message.run);
      case "run_event":
        this.queries.setQueryData<readonly RunEvent[]>(
          keys.runEvents(message.run),
          (events) => events && applyRunEvent(events, message.event),
        );
        return;
      case "question":
        return this.#question(message.question);
      case "notice":
        return this.#notice(message);
      case "alert":
        return this.#alert(message.alert);
      case "alerts":
        void this.queries.invalidateQueries({ queryKey: keys.alerts(this.slug) });
        return;
      case "armed":
        this.queries.setQueryData<ArmedProgram[]>(keys.armed(this.slug), message.programs);
        return;
      case "rehearsal":
        return this.#rehearsal(message);
      case "stop":
        return this.#stop({ active: message.active, by: message.by, at: message.at });
      case "traffic":
        useLiveStore.setState((state) => ({ traffic: { ...state.traffic, ...message.robots } }));
        return;
      case "programs":
        void this.queries.invalidateQueries({ queryKey: keys.programs(this.slug) });
    }
  }

  end(): void {
    clearTimeout(this.#timer);
  }

  /** After each (new) greeting the state is fetched anew: what happened meanwhile was missed. */
  #refresh(): void {
    const stale = [
      keys.devices,
      keys.site,
      keys.map,
      keys.runs,
      keys.programs,
      keys.questions,
      keys.armed,
      keys.alerts,
    ].map((key) => key(this.slug) as readonly string[]);
    const open = ["run", "run-events", "rehearsal", "compiled", "robot-map", "map-difference", "map-versions"].map(
      (name) => [name],
    );
    for (const queryKey of [...stale, ...open]) void this.queries.invalidateQueries({ queryKey });
  }

  #device(change: DeviceChange): void {
    recordDevice(change, performance.now());
    const before = useLiveStore.getState().deviceById[change.id];
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
    const applied = applyChanges(this.queries.getQueryData<Device[]>(key) ?? [], this.#changes);
    const news = [...this.#changes.values()].some((change) => "lifecycle" in change || "status" in change);
    this.#changes.clear();
    if (applied.devices.length > 0) this.queries.setQueryData(key, applied.devices);
    if (applied.strangers.length > 0) void this.queries.invalidateQueries({ queryKey: key });
    if (applied.strangers.length > 0 || news) this.#siteChanged();
  }

  #siteChanged(): void {
    void this.queries.invalidateQueries({ queryKey: keys.site(this.slug) });
    void this.queries.invalidateQueries({ queryKey: keys.sites });
  }

  #removed(id: string): void {
    this.queries.setQueryData<Device[]>(keys.devices(this.slug), (all) => all?.filter((each) => each.id !== id));
    this.#siteChanged();
  }

  #robotMap(device: string): void {
    const stale = [mapKeys.robot(this.slug, device), mapKeys.difference(this.slug, device)];
    for (const queryKey of stale) void this.queries.invalidateQueries({ queryKey });
  }

  #compiled({ type: _, program, ...compiled }: Extract<LiveMessage, { type: "compiled" }>): void {
    this.queries.setQueryData(keys.compiled(program), compiled);
  }

  #run(run: RunSummary): void {
    this.queries.setQueryData<RunSummary[]>(keys.runs(this.slug), (runs) => runs && applyRun(runs, run));
    this.queries.setQueryData<Run>(keys.run(run.id), (full) => full && { ...full, ...run });
  }

  #question(question: Question): void {
    this.queries.setQueryData<Question[]>(keys.questions(this.slug), (all) => applyQuestion(all ?? [], question));
  }

  #alert(alert: Alert): void {
    this.queries.setQueryData<Alert[]>(keys.alerts(this.slug), (all) => all && applyAlert(all, alert));
    if (alert.state === "over") void this.queries.invalidateQueries({ queryKey: keys.overAlerts(this.slug) });
  }

  #notice({ run, text, level }: Extract<LiveMessage, { type: "notice" }>): void {
    useLiveStore.setState(({ notices }) => {
      const id = (notices.at(-1)?.id ?? 0) + 1;
      return { notices: [...notices.slice(1 - NOTICES_KEPT), { id, run, text, level }] };
    });
  }

  #rehearsal(message: Extract<LiveMessage, { type: "rehearsal" }>): void {
    const key = keys.rehearsal(message.id);
    const { status, progress } = message;
    this.queries.setQueryData<Rehearsal>(key, (old) => old && { ...old, status, progress });
    if (status === "done" || status === "failed") void this.queries.invalidateQueries({ queryKey: key });
  }

  #stop(stop: SiteStop): void {
    useLiveStore.setState({ stop });
    this.queries.setQueryData<Site>(keys.site(this.slug), (site) => site && { ...site, stop });
  }
}
