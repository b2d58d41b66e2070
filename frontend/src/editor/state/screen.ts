/** What parts of the editor's screen lend to its commands while they are there. */
import { create } from "zustand";
import type { StageHandle } from "@/program/canvas/stageContext";

interface Screen {
  /** The map's view. */
  readonly stage: StageHandle | null;
  /** Begins a rehearsal; null while that is not possible. */
  readonly simulate: (() => void) | null;
  /** The steps of this program that a run is at. */
  readonly running: readonly string[];
}

/** Where the pointer was last over the map, pixels of the window. Nothing is drawn when it moves. */
export const lastPointer: { at: { readonly x: number; readonly y: number } | null } = { at: null };

export const useScreen = create<Screen>(() => ({ stage: null, simulate: null, running: [] }));
