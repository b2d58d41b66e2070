/** The shared Yjs document as plain frozen JSON; only what changed is read anew. */
import * as Y from "yjs";
import type { ProgramDocument, Step } from "@/program/document/document";
import { readMeta, readRecords, readStep, RECORDS, wellFormed } from "@/program/document/wellFormed";

export const ROOTS = ["meta", "steps", ...RECORDS] as const;

/** The whole document as it is. */
export function readDocument(doc: Y.Doc): ProgramDocument {
  const roots = Object.fromEntries(["steps", ...RECORDS].map((name) => [name, doc.getMap(name).toJSON()]));
  return wellFormed({ ...readSharedMeta(doc), ...roots });
}

/** The document after a transaction that changed only the roots and steps named. */
export function rereadDocument(
  doc: Y.Doc,
  previous: ProgramDocument,
  changed: ReadonlyMap<string, ReadonlySet<string>>,
): ProgramDocument {
  let next: ProgramDocument = { ...previous };
  if (changed.has("meta")) next = { ...next, ...readSharedMeta(doc) };
  for (const name of RECORDS)
    if (changed.has(name)) next = { ...next, [name]: readRecords(name, doc.getMap(name).toJSON()) };
  const ids = changed.get("steps");
  return ids ? { ...next, steps: rereadSteps(doc, previous.steps, ids) } : next;
}

/** The steps as they were, with those named as they are now. */
export function rereadSteps(
  doc: Y.Doc,
  previous: ProgramDocument["steps"],
  ids: ReadonlySet<string>,
): Record<string, Step> {
  const steps = new Map(Object.entries(previous));
  const shared = doc.getMap("steps");
  for (const id of ids) {
    if (shared.has(id)) steps.set(id, readSharedStep(shared.get(id)));
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

function readSharedMeta(doc: Y.Doc): Pick<ProgramDocument, "format" | "start_pos"> {
  const meta = doc.getMap("meta");
  return readMeta(meta.get("format"), meta.get("start_pos"));
}

/** Whatever another client wrote, what comes out has the shape of a step. */
function readSharedStep(value: unknown): Step {
  return readStep(value instanceof Y.AbstractType ? value.toJSON() : value);
}
