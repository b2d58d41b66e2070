/** What can be run or rehearsed: a program as it is drawn, or one of its versions, at its site. */
import type { Device, Site } from "@/api/types";
import type { MapPlace } from "@/map/floor/floor";
import type { Compiled, ProgramDocument } from "@/program/document/document";
import { roleOfStep } from "@/program/operation";
import { surroundingsOf } from "@/program/surroundings";
import { chipText, plainText, type Translate } from "@/program/words/stepWords";

export interface Startable {
  readonly program: { readonly id: string; readonly name: string };
  readonly site: Site;
  readonly document: ProgramDocument;
  readonly compiled: Compiled | null;
  readonly devices: readonly Device[];
  readonly places: readonly MapPlace[];
  /** The number of the version; null: the program as it is drawn now. */
  readonly version: number | null;
  /** Done when what was drawn is on the server. */
  readonly stored: () => Promise<void>;
}

export interface Choice {
  readonly value: string;
  readonly label: string;
}

/** The steps by their numbers, as one chooses among them; `say` is of the editor's texts. */
export function stepChoices(
  { document, compiled, devices, places }: Pick<Startable, "document" | "compiled" | "devices" | "places">,
  say: Translate,
): Choice[] {
  const speaker = { t: say, document, surroundings: surroundingsOf(devices, places) };
  return (compiled?.order ?? []).flatMap((id) => {
    const step = document.steps[id];
    if (!step || step.kind === "comment") return [];
    const label = [compiled?.numbers[id], say(`kind.${step.kind}`), plainText(chipText(step, speaker))];
    return [{ value: id, label: label.filter(Boolean).join(" · ") }];
  });
}

/** Of each role that a step uses its name and the robot that is to be it; no robot: any that can. */
export function robotsOf({ document, devices }: Pick<Startable, "document" | "devices">) {
  const used = Object.values(document.steps).flatMap((step) => roleOfStep(step) ?? []);
  return [...new Set(used)].map((id) => {
    const role = document.roles[id];
    const device = role?.device ?? null;
    return { role: role?.name ?? null, robot: devices.find((each) => each.id === device)?.name ?? device };
  });
}
