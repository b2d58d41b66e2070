/** What each part of a rehearsal's result is given. */
import type { ReactNode } from "react";
import type { Rehearsal, RehearsalResult } from "@/api/types";
import type { Incident } from "@/scene3d/incidents";

export interface ResultPanelProps {
  result: RehearsalResult;
  /** How it was asked for; of the oldest nobody knows. */
  asked: Rehearsal["asked"];
  incidents: readonly Incident[];
  /** What is said of an incident. */
  wordsOf: (incident: Incident) => string;
  /** The moment that is shown. */
  t_s: number;
  nameOf: (device: string) => string;
  numberOf: (step: string) => string;
  onJump: (t_s: number, step?: string) => void;
  /** What can be done with it. */
  children?: ReactNode;
}
