/** A problem's remedy as edits of the document. */
import { type Diagnostic, type Fix, type ProgramDocument, type Words } from "@/program/document/document";
import type { RecordName } from "@/program/document/wellFormed";
import { withDescendants } from "@/program/document/tree";
import { DEFAULT_ROLE, givenToRole, roleOfStep } from "@/program/operation";
import type { Edit } from "./edits";
import { deleteSteps, joinDrafts, type MakeId } from "./joints";

/** What a remedy may have to make: ids, and the name of the program's next robot. */
export interface Fresh {
  readonly makeId: MakeId;
  readonly robotName: (number: number) => string;
}

/** What a remedy changes; its words are for the screens. */
type Change = Pick<Fix, "step" | "field" | "value">;
type Remedy = (document: ProgramDocument, fix: Change, fresh: Fresh) => readonly Edit[];

/** The fields that are no parameter: the step itself, its place, its kind, the robot of one of its branches. */
const REMEDIES: Readonly<Record<string, Remedy>> = {
  place: joined,
  delete: (document, fix) => deleteSteps(document, [fix.step]),
  kind: changedKind,
  robot_of: ownRobot,
};

/** `field` is one of the above, else a parameter's name, or `args.name` inside one. */
export function fixEdits(document: ProgramDocument, fix: Change, fresh: Fresh): readonly Edit[] {
  if (fix.field === "part") return writtenAsRead(document, fix);
  if (!document.steps[fix.step]) return [];
  return (REMEDIES[fix.field] ?? changedParameter)(document, fix, fresh);
}

/** The library's version that this remedy brings in; it is fetched first. */
export function versionOf(fix: Change): { function: string; library: string; version: number } | null {
  if (fix.field !== "source.version" || typeof fix.value !== "object" || fix.value === null) return null;
  const { function: id, library, version } = fix.value as Record<string, unknown>;
  const whole = typeof id === "string" && typeof library === "string" && typeof version === "number";
  return whole ? { function: id, library, version } : null;
}

const SETTING = {
  functions: "set_function",
  roles: "set_role",
  parameters: "set_parameter",
  zones: "set_zone",
} as const satisfies Record<RecordName, Edit["do"]>;

/** What could not be read of a function, role, parameter or zone is gone once it is written as it was read. */
function writtenAsRead(document: ProgramDocument, fix: Change): readonly Edit[] {
  const { root, part } = fix.value as { root: RecordName; part: string };
  const value = document[root]?.[part];
  return value ? [{ do: SETTING[root], id: part, value } as Edit] : [];
}

function changedParameter(document: ProgramDocument, { step: id, field, value }: Change): readonly Edit[] {
  const [name = "", inner] = field.split(".", 2);
  if (inner === undefined) return [{ do: "set_param", id, name, value }];
  const whole = { ...(document.steps[id]?.params[name] as Record<string, unknown> | undefined), [inner]: value };
  return [{ do: "set_param", id, name, value: whole }];
}

function joined(document: ProgramDocument, { step }: Change): readonly Edit[] {
  const decision = joinDrafts(document, [step]);
  return "edits" in decision ? decision.edits : [];
}

function changedKind(document: ProgramDocument, { step: id, value }: Change): readonly Edit[] {
  const step = document.steps[id];
  return step && typeof value === "string" ? [{ do: "add_step", id, step: { ...step, kind: value, params: {} } }] : [];
}

/** Every step of the branch that the role drives gets a new role, for any robot. */
function ownRobot(document: ProgramDocument, fix: Change, fresh: Fresh): readonly Edit[] {
  const { branch, role } = fix.value as { branch: string; role: string };
  const inBranch = ([, step]: [string, ProgramDocument["steps"][string]]) =>
    step.place?.[0] === fix.step && step.place[1] === branch;
  const roots = Object.entries(document.steps).filter(inBranch);
  const ids = withDescendants(
    document,
    roots.map(([id]) => id),
  );
  const driven = [...ids].filter((id) => drivenBy(document, id) === role);
  if (driven.length === 0) return [];
  const id = fresh.makeId();
  const count = new Set([DEFAULT_ROLE, ...Object.keys(document.roles)]).size;
  return [
    { do: "set_role", id, value: { name: fresh.robotName(count + 1), can: [] } },
    ...driven.map((step): Edit => ({ do: "set_param", id: step, ...givenToRole(document.steps[step], id) })),
  ];
}

/** The role whose robot carries out the step, null where no robot does. */
export function drivenBy(document: ProgramDocument, id: string): string | null {
  return roleOfStep(document.steps[id]);
}

export function inLanguage(diagnostics: readonly Diagnostic[], language: string): readonly Diagnostic[] {
  return diagnostics.map((each) => ({
    ...each,
    message: wordsIn(each.messages, language, each.message),
    fix: each.fix ? { ...each.fix, label: wordsIn(each.fix.labels, language, each.fix.label) } : null,
  }));
}

function wordsIn(words: Words | undefined, language: string, english: string): string {
  return language.startsWith("de") ? (words?.de ?? english) : english;
}
