/** What a script is made of: its methods, what its run gives to names, its events and variables. Pure. */
import type { NamedDevice } from "./completion";
import { codeOf, methodsOf, namesIn, QUOTED } from "./pieces";

/** What run gives to a name: `get` of `oven01`. */
export interface Given {
  /** As the script has it: `ctx.get("oven01")`. */
  readonly what: string;
  readonly kind: string;
  readonly id: string;
}

export interface Parts {
  /** All of them, each with its heading. */
  readonly methods: ReadonlyMap<string, readonly string[]>;
  readonly given: ReadonlyMap<string, Given>;
  /** Lines such as `ctx.when(…, self.when_e1)`. */
  readonly events: readonly string[];
  /** The methods of branches and events: each belongs to one place, and nobody else calls it. */
  readonly inner: ReadonlySet<string>;
  /** Names behind `self.` that steps set. */
  readonly variables: ReadonlySet<string>;
  /** Names without `self.` that steps set. */
  readonly locals: ReadonlySet<string>;
}

const GIVEN = new RegExp(`^\\s*self\\.(\\p{ID_Continue}+)\\s*=\\s*(ctx\\.(\\w+)\\(\\s*(${QUOTED})?.*\\))$`, "u");
const EVENT = /^\s*ctx\.(when|start_when)\(/;
const SET = /^\s*(self\.)?(\p{ID_Continue}+)\s*(?::[^=]*)?(?:[-+*/%]{0,2})=(?!=)/u;

/** Of a tidied script: one statement in each line. */
export function partsOf(script: string): Parts {
  const methods = methodsOf(script);
  const given = new Map<string, Given>();
  const inner = new Set<string>();
  const events: string[] = [];
  const [variables, locals] = [new Set<string>(), new Set<string>()];
  for (const line of script.split("\n")) {
    const [, name = "", what = "", kind = "", id = ""] = GIVEN.exec(line) ?? [];
    const [, own, set = ""] = SET.exec(line) ?? [];
    if (EVENT.test(line)) events.push(line.trim());
    if (name) given.set(name, { what, kind, id: id.slice(1, -1) });
    else if (set) (own ? variables : locals).add(set);
    if (EVENT.test(line) || /\bself\.parallel\(/.test(codeOf(line)))
      for (const each of namesIn(line)) if (methods.has(each)) inner.add(each);
  }
  return { methods, given: withDrawnZones(given), events, inner, variables, locals };
}

/** A zone that a line only names is the one that another line draws. */
function withDrawnZones(given: ReadonlyMap<string, Given>): Map<string, Given> {
  const drawn = new Map([...given.values()].filter(isDrawn).map((each) => [each.id, each]));
  return new Map([...given].map(([name, each]) => [name, (each.kind === "zone" && drawn.get(each.id)) || each]));
}

/** Whether steps that mean what is given there may have what is given here to the same name, or to another one. */
export function meansSame(theirs: Given, ours: Given, devices: readonly NamedDevice[]): boolean {
  if (theirs.kind === "any") return mayBeAny(theirs, ours, devices);
  if (theirs.kind !== ours.kind) return false;
  if (theirs.kind === "parameter") return typeOf(theirs) === "" || typeOf(theirs) === typeOf(ours);
  return theirs.kind === "zone" ? isSameZone(theirs, ours) : theirs.id === ours.id;
}

/** Any robot may be the program's own; one that is chosen by what it reports, where the program chooses so. */
function mayBeAny(theirs: Given, ours: Given, devices: readonly NamedDevice[]): boolean {
  const chosen = (given: Given) => /where\s*=.*/.exec(given.what)?.[0];
  if (chosen(theirs) !== undefined) return chosen(theirs) === chosen(ours);
  if (ours.kind !== "get") return ours.kind === "any";
  return (devices.find(({ id }) => id === ours.id)?.kind ?? "robot") === "robot";
}

function typeOf({ what }: Given): string {
  return /,\s*(?!True|False|None)([A-Z]\w*(?:\(.*\))?)\s*\)$/.exec(what)?.[1]?.replaceAll("'", '"') ?? "";
}

/** Drawn alike under the same id or name; where one of them is only named, under the same id. */
function isSameZone(theirs: Given, ours: Given): boolean {
  if (!isDrawn(theirs) || !isDrawn(ours)) return theirs.id === ours.id;
  const called = (given: Given) => said(given, "name") || given.id;
  return drawnAs(theirs) === drawnAs(ours) && (theirs.id === ours.id || called(theirs) === called(ours));
}

export function isDrawn({ kind, what }: Given): boolean {
  return kind === "zone" && what.includes("[");
}

function drawnAs(given: Given): string {
  const corners = /\[([^\]]*)\]/.exec(given.what)?.[1] ?? "";
  const numbers = [...corners.matchAll(/-?[\d.]+(?:e[-+]?\d+)?/gi)].map(([each]) => Number(each));
  return JSON.stringify([numbers, said(given, "rule"), said(given, "door"), Number(said(given, "speed"))]);
}

function said({ what }: Given, key: string): string {
  const found = new RegExp(`\\b${key}\\s*=\\s*(?:"([^"]*)"|'([^']*)'|([\\d.]+))`).exec(what);
  return found?.slice(1).find((each) => each !== undefined) ?? "";
}
