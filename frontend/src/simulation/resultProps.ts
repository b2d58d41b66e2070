/** What each part of a rehearsal's result is given. */
import type { RehearsalResult } from "@/api/types";

export interface ResultPanelProps {
  result: RehearsalResult;
  nameOf: (device: string) => string;
  numberOf: (step: string) => string;
  onJump: (t_s: number, step?: string) => void;
}
