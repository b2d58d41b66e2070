/** What is on one person's screen: selection, tool, open panels. Never part of the document. */
import { create } from "zustand";
import type { BranchRef } from "@/program/document/tree";
import type { Clipping } from "../edits/clipping";
import type { Entry, Way } from "../shared/undoList";
import { RESTING, type Gesture } from "./tool";

export type DrawerTab = "script" | "problems" | "steps" | "tests" | "comments";
export type Dialog =
  | "run"
  | "rehearse"
  | "function"
  | "library"
  | "save_function"
  | "shortcuts"
  | "find"
  | "strangers"
  | "templates"
  | null;

/** A field of the inspector that waits for a press on a device. */
export interface FieldPick {
  readonly field: string;
  readonly choose: (device: string) => void;
}

export interface NextPlace {
  readonly branch: BranchRef;
  readonly link: string;
  readonly word: string;
  /** Behind this step, or at the beginning with null; at the end of the branch where it is not said. */
  readonly after?: string | null;
}

/** Where a step is added from the short list, and what stands there. */
export interface QuickAdd {
  /** Pixels of the window. */
  readonly x: number;
  readonly y: number;
  /** Metres. */
  readonly at: readonly [number, number];
  readonly device: string | null;
}

/** One entry that a toast offers to undo or redo. */
export interface Offer {
  readonly way: Way;
  readonly entry: Entry;
  /** It was asked whether what somebody else has set since may be overwritten. */
  readonly asked: boolean;
}

export interface EditorUi {
  gesture: Gesture;
  selected: readonly string[];
  /** The branch that the next step goes into, where it is not the selected step's. */
  into: NextPlace | null;
  /** The step made last, until something else is selected. */
  fresh: string | null;
  drawer: { readonly open: boolean; readonly tab: DrawerTab };
  /** The drawer takes half of the screen. */
  tallDrawer: boolean;
  inspector: boolean;
  /** On small screens: the sheet of the program itself. */
  programSheet: boolean;
  /** The device whose panel is open. */
  device: string | null;
  /** The list of constructs at a point of the map is open. */
  quick: QuickAdd | null;
  /** The list of all constructs is open. */
  more: boolean;
  dialog: Dialog;
  /** The function that "save_function" is about. */
  dialogFunction: string | null;
  /** What "find" begins with: the id of a device, or nothing. */
  find: string;
  fieldPick: FieldPick | null;
  /** What was copied here last, and what people call the devices and places in it. */
  clipboard: { readonly clipping: Clipping; readonly names: Readonly<Record<string, string>> } | null;
  collapsed: ReadonlySet<string>;
  toast: { readonly text: string; readonly offer: Offer | null; readonly at: number } | null;
}

const START: EditorUi = {
  gesture: RESTING,
  selected: [],
  into: null,
  fresh: null,
  drawer: { open: true, tab: "script" },
  tallDrawer: false,
  inspector: true,
  programSheet: false,
  device: null,
  quick: null,
  more: false,
  dialog: null,
  dialogFunction: null,
  find: "",
  fieldPick: null,
  clipboard: null,
  collapsed: new Set(),
  toast: null,
};

/** Small screens begin with the map alone. */
const ROOMY = typeof matchMedia !== "function" || matchMedia("(min-width: 1180px)").matches;

export const useUi = create<EditorUi>(() => ({ ...START, drawer: { ...START.drawer, open: ROOMY } }));

/** Another program: nothing selected, nothing in hand; what was copied stays. */
export function resetUi(): void {
  const { clipboard, drawer, tallDrawer } = useUi.getState();
  useUi.setState({ ...START, clipboard, drawer, tallDrawer });
}

/** A field that waits for a press on the map is not looked at any more, and waits no longer. */
export function select(ids: readonly string[]): void {
  useUi.setState((ui) => ({
    selected: ids,
    fieldPick: null,
    fresh: ui.fresh !== null && ids.includes(ui.fresh) ? ui.fresh : null,
    into: null,
    device: null,
    inspector: ids.length > 0 || ui.inspector,
    programSheet: ids.length === 0 && ui.programSheet,
  }));
}

/** Open the panel of a machine or robot. */
export function showDevice(device: string): void {
  select([]);
  useUi.setState({ device, inspector: true });
}

export function toggleSelected(id: string): void {
  const { selected } = useUi.getState();
  select(selected.includes(id) ? selected.filter((each) => each !== id) : [...selected, id]);
}

export const PROGRAM_BUTTON = "program-button";

/** Put the program's own panel away; the focus goes to the button that brings it back. */
export function hideProgram(): void {
  useUi.setState({ inspector: false, programSheet: false });
  requestAnimationFrame(() => document.getElementById(PROGRAM_BUTTON)?.focus());
}

export function showTab(tab: DrawerTab): void {
  useUi.setState({ drawer: { open: true, tab } });
}

export function say(text: string, offer: Offer | null = null): void {
  useUi.setState({ toast: { text, offer, at: Date.now() } });
}
