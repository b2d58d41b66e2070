/** A parameter under another name, with everything that reads, sets or gives it. */
import type { Edit } from "./edits";
import { namesSetIn, ownNames } from "./scopes";
import { paramsWith } from "./substitution";
import { ancestors } from "@/program/document/tree";
import type { FunctionDefinition, Parameter, ProgramDocument } from "@/program/document/document";

/** The function with the parameter changed; a new name goes into its body and its calls. */
export function changeParameter(
  document: ProgramDocument,
  functionId: string,
  index: number,
  next: Parameter,
): readonly Edit[] {
  const definition = document.functions[functionId];
  const before = definition?.parameters[index];
  if (!definition || !before) return [];
  const value: FunctionDefinition = {
    ...definition,
    parameters: definition.parameters.map((each, at) => (at === index ? next : each)),
  };
  const change: Edit = { do: "set_function", id: functionId, value };
  if (before.name === next.name) return [change];
  const inside = (top: string) => top === functionId;
  return [
    change,
    ...renameIn(document, before.name, next.name, inside),
    ...renameArguments(document, functionId, before.name, next.name),
  ];
}

/** The program's parameter changed; a new name goes wherever no function has that name for itself. */
export function changeProgramParameter(document: ProgramDocument, id: string, next: Parameter): readonly Edit[] {
  const before = document.parameters[id];
  const change: Edit = { do: "set_parameter", id, value: next };
  if (!before || before.name === next.name) return [change];
  const set = namesSetIn(document);
  const hiding = Object.keys(document.functions).filter((each) => ownNames(document, each, set).has(before.name));
  return [change, ...renameIn(document, before.name, next.name, (top) => !hiding.includes(top))];
}

/** The steps that read or set the name, but for those in a loop that has it for itself. */
function renameIn(document: ProgramDocument, before: string, after: string, applies: (top: string) => boolean): Edit[] {
  const names = new Map([[before, { param: after }]]);
  return Object.entries(document.steps).flatMap(([id, step]) => {
    if (!applies(ancestors(document, id).at(-1) ?? "")) return [];
    return Object.entries(paramsWith(document, id, names)).flatMap(([name, value]): Edit[] => {
      return JSON.stringify(value) === JSON.stringify(step.params[name]) ? [] : [{ do: "set_param", id, name, value }];
    });
  });
}

function renameArguments(document: ProgramDocument, functionId: string, before: string, after: string): Edit[] {
  return Object.entries(document.steps).flatMap(([id, step]): Edit[] => {
    const args = (step.params.args ?? {}) as Record<string, unknown>;
    if (step.kind !== "call" || step.params.function !== functionId || !Object.hasOwn(args, before)) return [];
    const renamed = Object.entries(args).map(([name, value]) => [name === before ? after : name, value] as const);
    return [{ do: "set_param", id, name: "args", value: Object.fromEntries(renamed) }];
  });
}
