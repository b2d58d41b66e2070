/** Each person's own keys, kept in this browser. */
import { create } from "zustand";
import { isCharacterKey } from "./keyNames";

export interface Keymap {
  /** Instead of a command's own keys; an empty list takes them all away. */
  readonly own: Readonly<Record<string, readonly string[]>>;
  /** Whether keys that write a character mean commands at all. */
  readonly characters: boolean;
}

export interface Keyed {
  readonly id: string;
  readonly keys: readonly string[];
  /** The keys are the system's or the browser's own and stay. */
  readonly fixed?: boolean;
}

export const PLAIN_KEYMAP: Keymap = { own: {}, characters: true };

interface KeymapStore extends Keymap {
  /** Whose it is; null before somebody has signed in. */
  readonly person: string | null;
}

export const useKeymap = create<KeymapStore>(() => ({ ...PLAIN_KEYMAP, person: null }));

/** The keys that a command has for this person. */
export function keysOf(command: Keyed, { own, characters }: Keymap): readonly string[] {
  const keys = (command.fixed ? undefined : own[command.id]) ?? command.keys;
  return characters ? keys : keys.filter((each) => !isCharacterKey(each));
}

/** Use the keys of this person from now on. */
export function openKeymap(person: string): void {
  useKeymap.setState({ person, ...readKeymap(localStorage.getItem(placeOf(person))) });
}

export function changeKeymap(change: Partial<Keymap>): void {
  useKeymap.setState(change);
  const { person, own, characters } = useKeymap.getState();
  if (person !== null) localStorage.setItem(placeOf(person), JSON.stringify({ own, characters }));
}

/** What was kept, as far as it makes sense. */
export function readKeymap(text: string | null): Keymap {
  try {
    const { own, characters } = JSON.parse(text ?? "{}") as Record<string, unknown>;
    const entries = Object.entries((own ?? {}) as Record<string, unknown>);
    const sound = entries.filter((entry): entry is [string, string[]] => isListOfTexts(entry[1]));
    return { own: Object.fromEntries(sound), characters: characters !== false };
  } catch {
    return PLAIN_KEYMAP;
  }
}

function isListOfTexts(value: unknown): boolean {
  return Array.isArray(value) && value.every((each) => typeof each === "string");
}

function placeOf(person: string): string {
  return `vipo.keys.${person}`;
}
