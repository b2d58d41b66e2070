/** The open program for all parts of the editor's screen. */
import { createContext, use } from "react";
import type { Device, Program, Site } from "@/api/types";
import type { FloorPlan } from "@/map/floor/floor";
import type { Edit } from "../edits/edits";
import type { SharedProgram } from "../shared/sharedProgram";
import type { Compiled, Diagnostic, ProgramDocument } from "@/program/document/document";
import type { Scene } from "@/program/scene/scene";
import type { Surroundings } from "@/program/surroundings";
import type { Speaker, Translate } from "@/program/words/stepWords";
import type { Person } from "./presence";

export interface OpenProgram {
  readonly program: Program;
  readonly site: Site;
  readonly plan: FloorPlan | null;
  readonly devices: readonly Device[];
  readonly shared: SharedProgram;
  readonly document: ProgramDocument;
  readonly compiled: Compiled | null;
  readonly diagnostics: readonly Diagnostic[];
  readonly scene: Scene;
  readonly surroundings: Surroundings;
  readonly speaker: Speaker;
  readonly t: Translate;
  readonly people: readonly Person[];
  /** The program is here, from the server or from this browser's copy; what is shown before is nobody's program. */
  readonly loaded: boolean;
  /** Viewers and operators look; authors and admins draw, once the program is here. */
  readonly canEdit: boolean;
  readonly canRun: boolean;
  readonly apply: (edits: readonly Edit[]) => void;
  /** Begin with the program anew, as the server has it. */
  readonly openAnew: () => void;
}

export const ProgramContext = createContext<OpenProgram | null>(null);

export function useOpenProgram(): OpenProgram {
  const open = use(ProgramContext);
  if (!open) throw new Error("This part belongs inside an open program.");
  return open;
}
