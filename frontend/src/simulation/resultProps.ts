/** What each part of a rehearsal's result is given. */
import type { Rehearsal, RehearsalResult } from "@/api/types";

export interface ResultPanelProps {
  result: RehearsalResult;
  /** How it was asked for; of the oldest nobody knows. */
  asked: Rehearsal["asked"];
  nameOf: (device: string) => string;
  numberOf: (step: string) => string;
  onJump: (t_s: number, step?: string) => void;
}
