/** Who else is here: their cursors, selections and what they edit, through awareness. */
import { useEffect, useState } from "react";
import { personColour } from "@/design/Avatar";
import type { Point } from "@/map/plane/projection";
import type { OtherPerson } from "@/program/canvas/StepChip";
import type { SharedProgram } from "../shared/sharedProgram";
import { useUi } from "./ui";

export interface Person extends OtherPerson {
  readonly client: number;
  readonly id: number | string;
  readonly selection: readonly string[];
  /** The step whose field they are in. */
  readonly editing: string | null;
  readonly me: boolean;
}

export interface Cursor {
  readonly client: number;
  readonly name: string;
  readonly colour: string;
  readonly at: readonly [number, number];
}

interface Shown {
  user?: { id?: number | string; name?: string; initials?: string };
  cursor?: [number, number] | null;
  selection?: string[];
  editing?: string | null;
  /** Steps under their pointer, and where, in metres. */
  drag?: Record<string, unknown> | null;
}

const CURSOR_EVERY_MS = 50;

/** Everybody in the room; changes with who is here and what is selected, not with cursors. */
export function usePeople(shared: SharedProgram | null): readonly Person[] {
  const [people, setPeople] = useState<readonly Person[]>([]);
  useEffect(() => {
    if (!shared) return;
    let last = "";
    const read = () => {
      const now = readPeople(shared);
      const print = JSON.stringify(now);
      if (print === last) return;
      last = print;
      setPeople(now);
    };
    read();
    shared.awareness.on("change", read);
    return () => shared.awareness.off("change", read);
  }, [shared]);
  return people;
}

function readPeople(shared: SharedProgram): Person[] {
  const people: Person[] = [];
  for (const [client, state] of shared.awareness.getStates() as Map<number, Shown>) {
    const me = client === shared.doc.clientID;
    if (!state.user?.name) continue;
    people.push({
      client,
      me,
      id: state.user.id ?? client,
      name: state.user.name,
      initials: state.user.initials ?? state.user.name.slice(0, 2).toUpperCase(),
      colour: personColour(state.user.name),
      selection: Array.isArray(state.selection) ? state.selection.map(String) : [],
      editing: typeof state.editing === "string" ? state.editing : null,
    });
  }
  return people.sort((one, other) => Number(other.me) - Number(one.me) || one.client - other.client);
}

/** The cursors of the others, as they are now. */
export function readCursors(shared: SharedProgram): Cursor[] {
  const cursors: Cursor[] = [];
  for (const [client, state] of shared.awareness.getStates() as Map<number, Shown>) {
    if (client === shared.doc.clientID || !state.user?.name || !Array.isArray(state.cursor)) continue;
    const [x, y] = state.cursor;
    if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
    cursors.push({
      client,
      name: state.user.name,
      colour: personColour(state.user.name),
      at: [x, y],
    });
  }
  return cursors;
}

/** Show the others what this person has selected, and in which field they are. */
export function useShowSelection(shared: SharedProgram | null, user: Shown["user"]): void {
  useEffect(() => {
    if (!shared) return;
    const { awareness } = shared;
    awareness.setLocalStateField("user", user);
    awareness.setLocalStateField("selection", [...useUi.getState().selected]);
    return useUi.subscribe((ui, before) => {
      if (ui.selected !== before.selected) awareness.setLocalStateField("selection", ui.selected.slice(0, 40));
    });
  }, [shared, user]);
}

/** A function that shows the others where the pointer is, at most 20 times a second. */
export function cursorShower(shared: SharedProgram): (at: readonly [number, number]) => void {
  let last = 0;
  return (at) => {
    const now = performance.now();
    if (now - last < CURSOR_EVERY_MS) return;
    last = now;
    shared.awareness.setLocalStateField("cursor", at);
  };
}

/** Steps that somebody else has selected, and who. */
export function othersOn(people: readonly Person[]): ReadonlyMap<string, OtherPerson> {
  const marked = new Map<string, OtherPerson>();
  for (const person of people) if (!person.me) for (const step of person.selection) marked.set(step, person);
  return marked;
}

/** A function that shows the others which steps this person holds and where, as often as the pointer. */
export function dragShower(shared: SharedProgram): (held: Readonly<Record<string, Point>> | null) => void {
  let last = 0;
  return (held) => {
    const now = performance.now();
    if (held && now - last < CURSOR_EVERY_MS) return;
    last = held ? now : 0;
    shared.awareness.setLocalStateField("drag", held);
  };
}

const NONE: ReadonlyMap<string, Point> = new Map();

/** Steps that others hold now, and where. */
export function useCarried(shared: SharedProgram): ReadonlyMap<string, Point> {
  const [carried, setCarried] = useState(NONE);
  useEffect(() => {
    const read = () => {
      const now = readCarried(shared);
      setCarried((before) => (now.size === 0 && before.size === 0 ? before : now));
    };
    shared.awareness.on("change", read);
    return () => shared.awareness.off("change", read);
  }, [shared]);
  return carried;
}

function readCarried(shared: SharedProgram): Map<string, Point> {
  const carried = new Map<string, Point>();
  for (const [client, state] of shared.awareness.getStates() as Map<number, Shown>) {
    if (client === shared.doc.clientID || typeof state.drag !== "object" || state.drag === null) continue;
    for (const [step, at] of Object.entries(state.drag)) if (isPoint(at)) carried.set(step, at);
  }
  return carried;
}

/** Other clients may say anything. */
function isPoint(value: unknown): value is Point {
  return Array.isArray(value) && value.length === 2 && value.every(Number.isFinite);
}
