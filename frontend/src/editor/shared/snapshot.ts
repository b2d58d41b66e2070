/** The shared Yjs document as plain frozen JSON; only what changed is read anew. */
import * as Y from "yjs";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";

const RECORDS = ["functions", "roles", "parameters", "zones"] as const;

export const ROOTS = ["meta", "steps", ...RECORDS] as const;

/** The whole document as it is. */
export function readDocument(doc: Y.Doc): ProgramDocument {
  const steps = Object.fromEntries([...doc.getMap("steps")].map(([id, value]) => [id, readStep(value)]));
  const records = Object.fromEntries(RECORDS.map((name) => [name, doc.getMap(name).toJSON()]));
  return { ...EMPTY_DOCUMENT, ...readMeta(doc), ...records, steps };
}

/** The document after a transaction that changed only the roots and steps named. */
export function rereadDocument(
  doc: Y.Doc,
  previous: ProgramDocument,
  changed: ReadonlyMap<string, ReadonlySet<string>>,
): ProgramDocument {
  let next: ProgramDocument = { ...previous };
  if (changed.has("meta")) next = { ...next, ...readMeta(doc) };
  for (const name of RECORDS) if (changed.has(name)) next = { ...next, [name]: doc.getMap(name).toJSON() };
  const ids = changed.get("steps");
  return ids ? { ...next, steps: rereadSteps(doc, previous.steps, ids) } : next;
}

function rereadSteps(doc: Y.Doc, previous: ProgramDocument["steps"], ids: ReadonlySet<string>): Record<string, Step> {
  const steps = new Map(Object.entries(previous));
  const shared = doc.getMap("steps");
  for (const id of ids) {
    if (shared.has(id)) steps.set(id, readStep(shared.get(id)));
    else steps.delete(id);
  }
  return Object.fromEntries(steps);
}

/** Which roots, and which entries of them, the events of one transaction touched. */
export function changedBy(root: string, events: readonly Y.YEvent<Y.AbstractType<unknown>>[]): Set<string> {
  const ids = new Set<string>();
  for (const event of events) {
    const [first] = event.path;
    if (first === undefined) for (const key of event.changes.keys.keys()) ids.add(key);
    else ids.add(String(first));
  }
  if (ids.size === 0) ids.add(root);
  return ids;
}

function readMeta(doc: Y.Doc): Pick<ProgramDocument, "format" | "start_pos"> {
  const meta = doc.getMap("meta");
  const [format, start] = [meta.get("format"), meta.get("start_pos")];
  return {
    format: typeof format === "number" ? format : EMPTY_DOCUMENT.format,
    start_pos: isPoint(start) ? start : null,
  };
}

/** Whatever another client wrote, what comes out has the shape of a step. */
function readStep(value: unknown): Step {
  const raw: unknown = value instanceof Y.Map ? value.toJSON() : value;
  const { kind, place, pos, params } = (typeof raw === "object" && raw ? raw : {}) as Record<string, unknown>;
  return {
    kind: typeof kind === "string" ? kind : "",
    place: isPlace(place) ? place : null,
    pos: isPoint(pos) ? pos : null,
    params: typeof params === "object" && params && !Array.isArray(params) ? (params as Step["params"]) : {},
  };
}

function isPoint(value: unknown): value is [number, number] {
  return Array.isArray(value) && value.length === 2 && value.every((each) => Number.isFinite(each));
}

function isPlace(value: unknown): value is [string, string, string] {
  return Array.isArray(value) && value.length === 3 && value.every((each) => typeof each === "string");
}
