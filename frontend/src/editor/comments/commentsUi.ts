/** What of the comments is on one person's screen: the form that is open, the threads that were opened, the pins. */
import { create } from "zustand";
import { select, showTab } from "../state/ui";
import type { About } from "./about";

export interface CommentsUi {
  /** What a new thread is about whose form is open. */
  readonly writing: About | null;
  /** Threads that were opened by their pin; the panel goes to the first. */
  readonly opened: readonly string[];
  /** Commented things are marked on the map. */
  readonly pins: boolean;
}

export const useComments = create<CommentsUi>(() => ({ writing: null, opened: [], pins: true }));

/** Open the form of a new thread. */
export function writeAbout(writing: About): void {
  useComments.setState({ writing });
  showComments();
}

/** Go to threads in the drawer. */
export function openThreads(opened: readonly string[]): void {
  useComments.setState({ opened });
  showComments();
}

/** On small screens the sheet of a selected step would lie over them. */
function showComments(): void {
  showTab("comments");
  if (matchMedia("(max-width: 1179px)").matches) select([]);
}

/** Another program: nothing written, nothing opened; whether pins are shown stays. */
export function resetComments(): void {
  useComments.setState({ writing: null, opened: [] });
}
