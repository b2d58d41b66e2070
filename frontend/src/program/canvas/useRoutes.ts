/** Planned routes, asked for together, kept for as long as the floor (`floorMark`) stays the same. */
import { useEffect, useMemo, useSyncExternalStore } from "react";
import { api, ApiProblem } from "@/api/client";
import { endsOfWay, type RouteLookup } from "../scene/stepPaths";
import { keepRoutes, keptRoutes } from "./keptRoutes";

type Path = readonly (readonly [number, number])[];
type Answer = { path: Path; length_m: number; seconds: number } | null;

const known = new Map<string, Answer>();
const asked = new Set<string>();
const listeners = new Set<() => void>();
let answered = 0;
const GATHER_MS = 30;
const AGAIN_MS = 2000;

/** A lookup that gets better: undefined for ways whose answer is still to come. */
export function useRoutes(site: string | undefined, floor: string | undefined, keys: readonly string[]): RouteLookup {
  const round = useSyncExternalStore(subscribe, () => answered);
  const wanted = [...new Set(keys)].join("\n");
  useEffect(() => {
    if (!site || !wanted) return;
    const timer = setTimeout(() => void askFor(site, floor, wanted.split("\n")), GATHER_MS);
    return () => clearTimeout(timer);
  }, [site, floor, wanted]);
  return useMemo<RouteLookup>(() => {
    const prefix = prefixOf(site, floor);
    return (key) => (round >= 0 ? pathOf(known.get(prefix + key)) : undefined);
  }, [site, floor, round]);
}

function subscribe(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

function pathOf(answer: Answer | undefined): Path | null | undefined {
  return answer === undefined ? undefined : (answer?.path ?? null);
}

/** How long the way is and takes, once it is known. */
export function knownRoute(site: string | undefined, floor: string | undefined, key: string): Answer {
  return known.get(prefixOf(site, floor) + key) ?? null;
}

function prefixOf(site: string | undefined, floor: string | undefined): string {
  return `${site ?? ""}@${floor ?? ""}:`;
}

/** Ask for the ways that are not known and not asked for; while the server does not answer, again and again. */
export async function askFor(site: string, floor: string | undefined, keys: readonly string[]): Promise<void> {
  const prefix = prefixOf(site, floor);
  const fresh = keys.filter((key) => !known.has(prefix + key) && !asked.has(prefix + key));
  if (fresh.length === 0) return;
  for (const key of fresh) asked.add(prefix + key);
  try {
    const answers = await api.post<Answer[]>(`/sites/${site}/routes`, { pairs: fresh.map(endsOfWay) });
    const told = fresh.map((key, index) => [key, answers[index] ?? null] as const);
    learn(prefix, told);
    void keepRoutes(site, floor, Object.fromEntries(told)).catch(() => {});
  } catch (error) {
    if (isPassing(error)) {
      setTimeout(() => void askFor(site, floor, fresh), AGAIN_MS);
      const kept: Record<string, Answer> = await keptRoutes<Answer>(site, floor).catch(() => ({}));
      learn(
        prefix,
        fresh.flatMap((key) => (key in kept ? [[key, kept[key] ?? null] as const] : [])),
      );
    }
  } finally {
    for (const key of fresh) asked.delete(prefix + key);
  }
}

function learn(prefix: string, told: readonly (readonly [string, Answer])[]): void {
  if (told.length === 0) return;
  for (const [key, answer] of told) known.set(prefix + key, answer);
  answered += 1;
  for (const listener of listeners) listener();
}

/** Silence, or a server that is busy or broken; a refusal is an answer, and the straight sketch stays. */
function isPassing(error: unknown): boolean {
  return error instanceof ApiProblem && (error.status === 0 || error.status === 429 || error.status >= 500);
}
