/** What screens read from the server, kept by TanStack Query; the live socket writes into the same caches. */
import { keepPreviousData, QueryClient, skipToken, useInfiniteQuery, useQuery } from "@tanstack/react-query";
import { api, ApiProblem, rememberCsrf, untilRefused } from "./client";
import type {
  ArmedProgram,
  Device,
  Finding,
  LibraryFunction,
  Me,
  Operations,
  OwnSession,
  Processes,
  Program,
  ProgramRelatives,
  Question,
  RehearsalSummary,
  Run,
  RunSummary,
  Site,
  SiteMap,
  SiteMapInfo,
  StepMeasured,
  Version,
  WholeVersion,
} from "./types";
import { areOf, isSameMap } from "./wholeMap";

/** The names of the caches. */
export const keys = {
  me: ["me"] as const,
  mySessions: ["my-sessions"] as const,
  sites: ["sites"] as const,
  site: (slug: string) => ["site", slug] as const,
  map: (slug: string) => ["map", slug] as const,
  devices: (slug: string) => ["devices", slug] as const,
  retiredDevices: (slug: string) => ["devices", slug, "retired"] as const,
  deviceEvents: (slug: string, id: string) => ["device-events", slug, id] as const,
  paces: (slug: string, id: string) => ["paces", slug, id] as const,
  measurements: (run: string) => ["measurements", run] as const,
  rdf: (slug: string, id: string) => ["rdf", slug, id] as const,
  programs: (slug: string) => ["programs", slug] as const,
  program: (id: string) => ["program", id] as const,
  versionRuns: (slug: string, program: string) => ["runs", slug, "versions", program] as const,
  runs: (slug: string) => ["runs", slug] as const,
  openRuns: (slug: string) => ["runs", slug, "open"] as const,
  run: (id: string) => ["run", id] as const,
  questions: (slug: string) => ["questions", slug] as const,
  admissions: (slug: string) => ["admissions", slug] as const,
  armed: (slug: string) => ["armed", slug] as const,
  alerts: (slug: string) => ["alerts", slug] as const,
  overAlerts: (slug: string) => ["over-alerts", slug] as const,
  runEvents: (id: string) => ["run-events", id] as const,
  runTimeline: (id: string) => ["run-timeline", id] as const,
  library: (q: string, fits: string, onlyFitting: boolean) => ["library", q, fits, onlyFitting] as const,
  libraryFunction: (id: string, ...more: readonly (string | number)[]) => ["library-function", id, ...more] as const,
  rehearsal: (id: string) => ["rehearsal", id] as const,
  findings: (slug: string) => ["findings", slug] as const,
  operations: (slug: string) => ["operations", slug] as const,
  processes: (slug: string) => ["processes", slug] as const,
  versions: (id: string) => ["versions", id] as const,
  version: (id: string, number: number) => ["version", id, number] as const,
  threads: (id: string) => ["threads", id] as const,
  tests: (id: string) => ["tests", id] as const,
  peopleToMention: (id: string) => ["people-to-mention", id] as const,
  comparison: (id: string) => ["comparison", id] as const,
  reviews: ["review"] as const,
  /** What a site has set, by its address below the site, such as `review-rule`. */
  setting: (slug: string, address: string) => [address, slug] as const,
  rehearsals: (slug: string) => ["rehearsals", slug] as const,
};

/** A refusal is an answer: only silence and a busy server are worth another try. */
function retry(failures: number, error: Error): boolean {
  const again = error instanceof ApiProblem && (error.status === 0 || error.status >= 502);
  return again && failures < 3;
}

/**
 * Without a network a call fails at once, with a sentence, instead of waiting unseen: a Stop all, or the reset of one,
 * that is carried out when the network comes back is the last thing that anybody expects.
 */
const networkMode = "always";

export function makeQueryClient(): QueryClient {
  const queries = {
    retry,
    networkMode,
    staleTime: 30_000,
    refetchOnWindowFocus: false,
    refetchOnReconnect: true,
  } as const;
  return new QueryClient({ defaultOptions: { queries, mutations: { networkMode } } });
}

async function getMe(): Promise<Me> {
  const me = await api.get<Me>("/me");
  rememberCsrf(me.csrf);
  return me;
}

/**
 * The cells of a map never change: those that are known are not fetched again, and stay the same array.
 *
 * Somebody may save a map between the two answers: the cells are always those of the version that the map tells.
 */
async function getMap(slug: string, known: SiteMap | undefined): Promise<SiteMap> {
  const path = `/sites/${slug}/map`;
  const getInfo = () => api.get<SiteMapInfo>(path);
  const getNewest = () => api.tagged(`${path}/cells`); // kept for the time without a server, as a version's are not
  const [info, newest] = known ? [await getInfo(), null] : await Promise.all([getInfo(), getNewest()]);
  if (known && isSameMap(info, known)) return { ...info, cells: known.cells };
  const { tag, bytes } = newest ?? (await getNewest());
  return { ...info, cells: areOf(info, tag) ? bytes : await api.bytes(`${path}/versions/${info.version}/cells`) };
}

/** A query that waits until its subject is known. */
export function useGet<T>(key: readonly unknown[], path: string | null) {
  return useQuery({ queryKey: key, queryFn: path === null ? skipToken : () => api.get<T>(path) });
}

/** The same for a list that the server gives in parts. */
function useAll<T>(key: readonly unknown[], path: string | null) {
  return useQuery({ queryKey: key, queryFn: path === null ? skipToken : () => api.all<T>(path) });
}

/**
 * What tells whether parts of VIPO are dead is asked for anew, over and over: the live news come through such parts.
 * What was known last stays while no answer comes; the screen says how old it is.
 */
function useWatch<T>(key: readonly unknown[], path: string | null, everyMs: number) {
  return useQuery({
    queryKey: key,
    queryFn: path === null ? skipToken : () => api.get<T>(path),
    refetchInterval: untilRefused(everyMs),
    staleTime: 0,
  });
}

/** What is not known yet is not asked for. */
export type Maybe = string | undefined;
const at = (id: Maybe, path: (id: string) => string) => (id ? path(encodeURIComponent(id)) : null);

/** Who looks at this; asked for before anything is drawn. */
export const ME = { queryKey: keys.me, queryFn: getMe, staleTime: Infinity } as const;
export const useMe = () => useQuery(ME);
export const useMySessions = (ending: boolean) => useAll<OwnSession>(keys.mySessions, ending ? null : "/me/sessions");
export const useSites = () => useGet<Site[]>(keys.sites, "/sites");
export const useSite = (slug: Maybe) =>
  useGet<Site>(
    keys.site(slug ?? ""),
    at(slug, (s) => `/sites/${s}`),
  );
export const useSiteMap = (slug: Maybe) =>
  useQuery({
    queryKey: keys.map(slug ?? ""),
    queryFn: slug ? ({ client, queryKey }) => getMap(slug, client.getQueryData<SiteMap>(queryKey)) : skipToken,
    staleTime: Infinity,
  });
export const useDevices = (slug: Maybe) =>
  useGet<Device[]>(
    keys.devices(slug ?? ""),
    at(slug, (s) => `/sites/${s}/devices`),
  );
export const useRetiredDevices = (slug: Maybe) =>
  useGet<Device[]>(
    keys.retiredDevices(slug ?? ""),
    at(slug, (s) => `/sites/${s}/devices?lifecycle=retired`),
  );
export const usePrograms = (slug: Maybe) =>
  useAll<Program>(
    keys.programs(slug ?? ""),
    at(slug, (s) => `/sites/${s}/programs`),
  );
export const useProgram = (id: Maybe) =>
  useGet<Program>(
    keys.program(id ?? ""),
    at(id, (p) => `/programs/${p}`),
  );
/** All runs of a site that are not over, however old they are: those that are planned, too. */
export const useOpenRuns = (slug: Maybe) =>
  useAll<RunSummary>(
    keys.openRuns(slug ?? ""),
    at(slug, (s) => `/sites/${s}/runs?state=open&limit=200`),
  );
export const useQuestions = (slug: Maybe) =>
  useGet<Question[]>(
    keys.questions(slug ?? ""),
    at(slug, (s) => `/sites/${s}/questions`),
  );
export const useArmed = (slug: Maybe) =>
  useGet<ArmedProgram[]>(
    keys.armed(slug ?? ""),
    at(slug, (s) => `/sites/${s}/armed`),
  );
export const useRun = (id: Maybe) =>
  useGet<Run>(
    keys.run(id ?? ""),
    at(id, (r) => `/runs/${r}`),
  );
export const useMeasurements = (run: Maybe) =>
  useGet<StepMeasured[]>(
    keys.measurements(run ?? ""),
    at(run, (r) => `/runs/${r}/measurements`),
  );
const FUNCTIONS_AT_ONCE = 60;
/**
 * The functions that have the words, by name, part after part. What was found last stays until the next answer is
 * there: a list that goes while people type cannot be pressed.
 */
export const useLibrary = (q: string, fits = "", onlyFitting = false) => {
  const only = onlyFitting ? "&only_fitting=true" : "";
  const asked = `q=${encodeURIComponent(q)}&fits=${encodeURIComponent(fits)}${only}`;
  return useInfiniteQuery({
    queryKey: keys.library(q, fits, onlyFitting),
    queryFn: ({ pageParam }) => api.part<LibraryFunction>(pageParam),
    initialPageParam: `/library?limit=${FUNCTIONS_AT_ONCE}&${asked}`,
    getNextPageParam: (last) => last.next,
    select: ({ pages }) => pages.flatMap(({ items }) => items),
    placeholderData: keepPreviousData,
  });
};
export const useLibraryFunction = (id: Maybe, fits = "") =>
  useGet<LibraryFunction>(
    keys.libraryFunction(id ?? "", fits),
    at(id, (f) => `/library/${f}?fits=${encodeURIComponent(fits)}`),
  );
export const useFindings = (slug: Maybe) =>
  useWatch<Finding[]>(
    keys.findings(slug ?? ""),
    at(slug, (s) => `/sites/${s}/findings`),
    5_000,
  );
export const useOperations = (slug: Maybe) =>
  useWatch<Operations>(
    keys.operations(slug ?? ""),
    at(slug, (s) => `/sites/${s}/operations`),
    2_000,
  );
export const useProcesses = (slug: Maybe) =>
  useWatch<Processes>(
    keys.processes(slug ?? ""),
    at(slug, (s) => `/sites/${s}/processes`),
    2_000,
  );
/** Those of a site that are not over. */
export const useRehearsals = (slug: Maybe) =>
  useGet<RehearsalSummary[]>(
    keys.rehearsals(slug ?? ""),
    at(slug, (s) => `/sites/${s}/rehearsals`),
  );
const VERSIONS_AT_ONCE = 50;
/** A program's versions, the newest first, part after part. */
export const useVersions = (id: Maybe) =>
  useInfiniteQuery({
    queryKey: keys.versions(id ?? ""),
    queryFn: id ? ({ pageParam }) => api.part<Version>(pageParam) : skipToken,
    initialPageParam: `/programs/${encodeURIComponent(id ?? "")}/versions?limit=${VERSIONS_AT_ONCE}`,
    getNextPageParam: (last: { next?: string }) => last.next,
  });
/** What a version holds never changes. */
export const useVersion = (id: Maybe, number: number, wanted: boolean) =>
  useQuery({
    queryKey: keys.version(id ?? "", number),
    queryFn: id && wanted ? () => api.get<WholeVersion>(`/programs/${id}/versions/${number}`) : skipToken,
    staleTime: Infinity,
  });

/** Which program of another site a program was made from, and which there were made from it; as far as one sees them. */
export const useRelatives = (id: Maybe) =>
  useQuery({
    queryKey: ["program-origin", id],
    queryFn: id ? () => api.get<ProgramRelatives>(`/programs/${id}/origin`) : skipToken,
  });
