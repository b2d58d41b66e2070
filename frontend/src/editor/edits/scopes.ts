/** Which name means what where: those of a For-each belong to its loop, a parameter and what only a function sets to
each call of the function, all else to the program. Where several have one name, the nearest is meant. */
import { fieldsOf, STEP_KINDS } from "@/program/kinds";
import { textOf, type ProgramDocument, type Step } from "@/program/document/document";
import { ancestors, PROGRAM } from "@/program/document/tree";

const SETTING: ReadonlyMap<string, readonly string[]> = new Map(
  STEP_KINDS.map(({ kind }) => [kind, fieldsOf(kind).flatMap(({ name, type }) => (type === "variable" ? [name] : []))]),
);

/** The parameters of a step that hold the name of something that it sets. */
export function settingFields({ kind }: Step): readonly string[] {
  return SETTING.get(kind) ?? [];
}

/** The names that a For-each gives to its item and to the number of the round; of any other step none. */
export function loopNames(step: Step | undefined): string[] {
  return step?.kind === "for_each" ? [step.params.variable, step.params.index].map((name) => textOf(name)) : [];
}

/** All names that a step gives a value to: what it sets, and those of its loop. */
export function namesGivenBy(step: Step): string[] {
  const set = settingFields(step).map((field) => textOf(step.params[field]));
  return [...loopNames(step), ...set].filter(Boolean);
}

/** The names of all loops around a step: in it they mean what these loops give. */
export function namesOfLoops(document: ProgramDocument, id: string): ReadonlySet<string> {
  return new Set(ancestors(document, id).flatMap((above) => loopNames(document.steps[above])));
}

const NOTHING: ReadonlySet<string> = new Set();

/** The names of no loop that are set in the program with its events, and in the body of each function, by its id. */
export function namesSetIn(document: ProgramDocument): ReadonlyMap<string, ReadonlySet<string>> {
  const found = new Map<string, Set<string>>();
  for (const [id, step] of Object.entries(document.steps)) {
    const names = settingFields(step).flatMap((field) => textOf(step.params[field]) || []);
    const top = names.length === 0 ? undefined : ancestors(document, id).at(-1);
    if (top === undefined) continue;
    const ofLoops = namesOfLoops(document, id);
    const known = found.get(top) ?? new Set();
    for (const name of names) if (!ofLoops.has(name)) known.add(name);
    found.set(top, known);
  }
  return found;
}

/** A function's parameters, and what it sets and the program does not: each call has its own. */
export function ownNames(
  document: ProgramDocument,
  functionId: string,
  set = namesSetIn(document),
): ReadonlySet<string> {
  const ofProgram = set.get(PROGRAM.parent) ?? NOTHING;
  const parameters = document.functions[functionId]?.parameters ?? [];
  const locals = [...(set.get(functionId) ?? NOTHING)].filter((name) => !ofProgram.has(name));
  return new Set([...parameters.map(({ name }) => name), ...locals]);
}

/** All names that steps set, loops give and parameters have, without those of one function and its body. */
export function namesBeside(document: ProgramDocument, functionId: string | null): ReadonlySet<string> {
  const others = Object.entries(document.functions).filter(([id]) => id !== functionId);
  const parameters = [...Object.values(document.parameters), ...others.flatMap(([, each]) => each.parameters)];
  const steps = Object.entries(document.steps).filter(
    ([id]) => functionId === null || ancestors(document, id).at(-1) !== functionId,
  );
  const named = steps.flatMap(([, step]) => namesGivenBy(step));
  return new Set([...parameters.map(({ name }) => name), ...named]);
}

/** The name itself, or with the first number that makes it one of its own. */
export function numbered(stem: string, taken: ReadonlySet<string>): string {
  for (let count = 1; ; count += 1) {
    const name = count === 1 ? stem : `${stem}${count}`;
    if (!taken.has(name)) return name;
  }
}
