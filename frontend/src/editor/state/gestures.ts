/** What gestures keep on one person's screen: the open menu, the zone in hand, ghosts, whose view is followed. */
import type { ComponentType } from "react";
import { create } from "zustand";
import type { OpenProgram } from "./context";
import { select } from "./ui";
import type { PixelPoint } from "@/map/plane/paths";
import type { Position, Step } from "@/program/document/document";

export interface MenuItem {
  readonly id: string;
  readonly label: string;
  readonly keys?: string;
  readonly icon?: ComponentType<{ size?: number }>;
  /** Items of one group stand together. */
  readonly group?: string;
  /** With the program as it is when the item is chosen, not when the menu opened. */
  readonly run: (now: OpenProgram) => void;
}

export interface OpenMenu {
  /** Pixels of the window. */
  readonly at: { readonly x: number; readonly y: number };
  readonly label: string;
  readonly items: readonly MenuItem[];
}

/** A step that this person had selected, or had changed unsaved, when somebody else took it away. */
export interface Ghost {
  readonly id: string;
  /** The step, and what stood in it and went with it, as they were. */
  readonly steps: Readonly<Record<string, Step>>;
  /** Where it was drawn, in drawing pixels; nothing where it was not, in a closed frame, say. */
  readonly at?: PixelPoint;
  /** A change of this person's went with it, made without a connection, say. */
  readonly changed: boolean;
}

export interface GestureUi {
  menu: OpenMenu | null;
  /** The selected zone. */
  zone: string | null;
  /** Corners of the zone that is being drawn. */
  corners: readonly Position[];
  ghosts: readonly Ghost[];
  /** The Yjs client whose view is followed. */
  following: number | null;
}

const START: GestureUi = { menu: null, zone: null, corners: [], ghosts: [], following: null };

export const useGestures = create<GestureUi>(() => START);

export function resetGestures(): void {
  useGestures.setState(START);
}

export function selectZone(zone: string | null): void {
  if (zone !== null) select([]);
  useGestures.setState({ zone });
}
