/**
 * The text of a test as its form has it, and back. Only what the form has changed is written: comments, order and what a
 * form does not know stay as they are. Pure.
 */
import { type Document, isMap, isScalar as isScalarNode, isSeq, parseDocument } from "yaml";

export type Scalar = string | number | boolean;
export const GIVEN = ["stock", "carrying", "readings"] as const;
export type GivenKind = (typeof GIVEN)[number];
export type Entry = Readonly<Record<string, unknown>>;

/** One line under `given`: what a machine holds, what a robot carries, or what a reading shows. */
export interface Given {
  readonly kind: GivenKind;
  readonly device: string;
  readonly name: string;
  readonly value: Scalar;
}

export interface TestValues {
  readonly name: string;
  readonly given: readonly Given[];
  /** Null: as it is where nothing is said. */
  readonly seed: number | null;
  readonly driver: string | null;
  readonly limit_s: number | null;
  readonly parameters: Readonly<Record<string, Scalar>>;
  readonly faults: readonly Entry[];
  readonly then: readonly Entry[];
}

type Path = readonly (string | number)[];

const isTable = (value: unknown): value is Entry =>
  typeof value === "object" && value !== null && !Array.isArray(value);
const isScalar = (value: unknown): value is Scalar => ["string", "number", "boolean"].includes(typeof value);
const isNothing = (value: unknown) => value === undefined || value === null;

/** The server reads YAML 1.1, in which `yes` is no text. */
function parsed(text: string): Document {
  return parseDocument(text, { version: "1.1", prettyErrors: false, keepSourceTokens: false });
}

/** What a text says; null where that is nothing that a form can show. */
export function readValues(text: string): TestValues | null {
  const document = parsed(text);
  if (document.errors.length > 0) return null;
  const test = plain(document);
  if (!isTable(test)) return null;
  const [given, when] = [test.given ?? {}, test.when ?? {}];
  if (!isTable(given) || !isTable(when)) return null;
  const lines = GIVEN.flatMap((kind) => givenLines(kind, given[kind]));
  const parameters = when.parameters ?? {};
  const [faults, then] = [when.faults ?? [], test.then ?? []];
  if (lines.includes(null) || !isScalars(parameters) || !isTables(faults) || !isTables(then)) return null;
  return {
    name: isScalar(test.name) ? String(test.name) : "",
    given: lines.flatMap((line) => line ?? []),
    seed: numberIn(when, "seed"),
    driver: typeof when.driver === "string" ? when.driver : null,
    limit_s: numberIn(when, "limit_s"),
    parameters,
    faults,
    then,
  };
}

/** Null where references would make it larger than anybody writes. */
function plain(document: Document): unknown {
  try {
    return document.toJS({ maxAliasCount: 10 });
  } catch (error) {
    if (error instanceof ReferenceError) return null;
    throw error;
  }
}

const isScalars = (value: unknown): value is Readonly<Record<string, Scalar>> =>
  isTable(value) && Object.values(value).every(isScalar);
const isTables = (value: unknown): value is readonly Entry[] => Array.isArray(value) && value.every(isTable);
const numberIn = (table: Entry, name: string) => (typeof table[name] === "number" ? table[name] : null);

function givenLines(kind: GivenKind, devices: unknown): (Given | null)[] {
  if (isNothing(devices)) return [];
  if (!isTable(devices)) return [null];
  return Object.entries(devices).flatMap(([device, values]) => {
    if (!isScalars(values)) return [null];
    return Object.entries(values).map(([name, value]) => ({ kind, device, name, value }));
  });
}

/** The text with other values in the places of those that are given. */
export function writeValues(text: string, change: Partial<TestValues>): string {
  const document = parsed(text);
  const { name, given, then } = change;
  if (name !== undefined) assign(document, ["name"], name);
  if (given !== undefined)
    for (const kind of GIVEN)
      assignIn(document, "given", kind, nonEmpty(tableOf(given.filter((each) => each.kind === kind))));
  for (const word of ["seed", "driver", "limit_s"] as const)
    if (change[word] !== undefined) assignIn(document, "when", word, change[word] ?? undefined);
  if (change.parameters !== undefined) assignIn(document, "when", "parameters", nonEmpty(change.parameters));
  if (change.faults !== undefined) assignIn(document, "when", "faults", nonEmpty(change.faults));
  if (then !== undefined) assign(document, ["then"], then);
  return document.toString({ lineWidth: 0, flowCollectionPadding: false, indentSeq: !/^- /m.test(text) });
}

function tableOf(lines: readonly Given[]): Record<string, Record<string, Scalar>> {
  const table: Record<string, Record<string, Scalar>> = {};
  for (const { device, name, value } of lines) table[device] = { ...table[device], [name]: value };
  return table;
}

function nonEmpty<T extends object>(value: T): T | undefined {
  return Object.keys(value).length > 0 ? value : undefined;
}

/** A value within `given` or `when`, which go with the last that stands in them. */
function assignIn(document: Document, part: string, word: string, value: unknown): void {
  if (value === undefined && !document.hasIn([part, word])) return;
  if (isNothing(document.getIn([part]))) document.set(part, document.createNode({}));
  assign(document, [part, word], value);
  const held = document.getIn([part], true);
  if (isMap(held) && held.items.length === 0) document.delete(part);
}

/** Put a value into its place; where it is a table or a list, only what differs in it. */
function assign(document: Document, path: Path, value: unknown): void {
  const node = document.getIn(path, true);
  if (value === undefined) document.deleteIn(path);
  else if (isMap(node) && isTable(value)) {
    const there = Object.keys(node.toJS(document) as object);
    for (const key of there) if (!(key in value)) document.deleteIn([...path, key]);
    for (const [key, each] of Object.entries(value)) assign(document, [...path, key], each);
  } else if (isSeq(node) && Array.isArray(value)) assignList(document, path, node.toJS(document) as unknown[], value);
  else if (isSame(document.getIn(path), value)) return;
  else if (isScalarNode(node) && isScalar(value)) {
    node.value = value;
    delete node.format; // of the number that stood there
  } else document.setIn(path, document.createNode(value));
}

/** A list keeps the entries that are the same, with their comments, before and behind what was changed. */
function assignList(document: Document, path: Path, before: readonly unknown[], after: readonly unknown[]): void {
  let first = 0;
  while (first < Math.min(before.length, after.length) && isSame(before[first], after[first])) first += 1;
  let same = 0;
  const most = Math.min(before.length, after.length) - first;
  while (same < most && isSame(before[before.length - 1 - same], after[after.length - 1 - same])) same += 1;
  const [gone, come] = [before.length - same, after.length - same];
  for (let at = first; at < Math.min(gone, come); at += 1) assign(document, [...path, at], after[at]);
  for (let at = gone - 1; at >= come; at -= 1) document.deleteIn([...path, at]);
  const node = document.getIn(path, true);
  if (isSeq(node))
    for (let at = gone; at < come; at += 1) node.items.splice(at, 0, document.createNode(after[at]) as never);
}

function isSame(one: unknown, other: unknown): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}
