/** The names that a step can read: loop variables, parameters and what is set anywhere; none is declared. */
import { isCatch } from "@/program/document/catches";
import { ancestors } from "@/program/document/tree";
import { namesBeside, numbered } from "./scopes";
import type { Answer, Parameter, ProgramDocument, Step } from "@/program/document/document";

/** Nearest first: loops and catches around the step, its function's parameters, what is set, the program's parameters. */
export function knownNames(document: ProgramDocument, id: string): readonly Parameter[] {
  const around = ancestors(document, id);
  const scope = around.at(-1) ?? "";
  const nearer = [id, ...around.slice(0, -1)];
  const near = around.flatMap((each, index) => [
    ...loopName(document.steps[each], document),
    ...ofProblem(document.steps[each], document.steps[nearer[index] ?? ""]),
  ]);
  const own = document.functions[scope]?.parameters ?? [];
  return onePerName([
    ...near,
    ...own,
    ...namesSet(document, document.functions[scope] ? scope : null),
    ...namesSet(document, null),
    ...Object.values(document.parameters),
  ]);
}

/** What the program and its events set, or, for a function, what its body sets. */
export function namesSet(document: ProgramDocument, functionId: string | null): readonly Parameter[] {
  const found = Object.entries(document.steps).flatMap(([id, step]) => {
    if (!step.place) return [];
    const top = ancestors(document, id).at(-1);
    return (functionId ?? "program") === top ? setName(step, document) : [];
  });
  return onePerName(found);
}

/** A name that nothing has yet: "item", "item2", … */
export function freshName(document: ProgramDocument, stem: string): string {
  return numbered(stem, namesBeside(document, null));
}

/** A name as the script can have it. */
export function asName(text: string): string {
  const clean = text
    .trim()
    .replace(/[^\p{L}\p{N}_]+/gu, "_")
    .replace(/^_+|_+$/g, "");
  return /^\p{N}/u.test(clean) ? `_${clean}` : clean;
}

function setName(step: Step, document: ProgramDocument): Parameter[] {
  switch (step.kind) {
    case "set":
      return named(step.params.variable, typeOf(step.params.value));
    case "ask":
      return named(step.params.variable, answerType(step.params.answer as Answer | undefined));
    case "call":
      return named(step.params.result, document.functions[String(step.params.function)]?.result ?? { type: "number" });
    default:
      return [];
  }
}

function loopName(step: Step | undefined, document: ProgramDocument): Parameter[] {
  if (step?.kind !== "for_each") return [];
  return [
    ...named(step.params.index, { type: "number" }),
    ...named(step.params.variable, typeOf(itemsOf(listOf(step, document))[0])),
  ];
}

/** What a catch knows of the failure; `inner` is the step that stands in the Try. */
function ofProblem(step: Step | undefined, inner: Step | undefined): Parameter[] {
  if (step?.kind !== "try" || !isCatch(inner?.place?.[1])) return [];
  return ["problem.text", "problem.kind"].map((name) => ({ name, type: "text" }));
}

type Typed = { readonly type: string; readonly unit?: string | null };

function named(name: unknown, typed: Typed): Parameter[] {
  return typeof name === "string" && name ? [{ name, ...typed }] : [];
}

function typeOf(value: unknown): Typed {
  if (typeof value === "string") return { type: "text" };
  if (typeof value === "boolean") return { type: "boolean" };
  if (typeof value !== "object" || value === null) return { type: "number" };
  if ("quantity" in value && Array.isArray(value.quantity)) return { type: "number", unit: String(value.quantity[1]) };
  if (Array.isArray(value)) return { type: "list" };
  if ("op" in value) return typeOfOperation(value);
  if (!("at" in value) || typeof value.at !== "object" || value.at === null) return { type: "number" };
  return { type: "device" in value.at ? "device" : "place" };
}

function typeOfOperation({ op, args }: { readonly op: unknown; readonly args?: unknown }): Typed {
  if (op === "text" || op === "list") return { type: op };
  const [first] = Array.isArray(args) ? (args as readonly unknown[]) : [];
  return op === "+" && first !== undefined && typeOf(first).type === "list" ? { type: "list" } : { type: "number" };
}

/** What a loop goes through: what is named in it, or what its variable is first set to that has items. */
function listOf(step: Step, document: ProgramDocument): unknown {
  const { list, items } = step.params;
  if (typeof list !== "object" || list === null || !("param" in list)) return items;
  const setting = Object.values(document.steps).filter((each) => each.kind === "set");
  const values = setting.filter((each) => each.params.variable === list.param).map((each) => each.params.value);
  return values.find((value) => itemsOf(value).length > 0);
}

/** The items that a list is written with. */
function itemsOf(value: unknown): readonly unknown[] {
  if (Array.isArray(value)) return value as readonly unknown[];
  if (typeof value !== "object" || value === null || !("op" in value) || !("args" in value)) return [];
  return value.op === "list" && Array.isArray(value.args) ? (value.args as readonly unknown[]) : [];
}

function answerType(answer: Answer | undefined): Typed {
  const type = answer?.type ?? "boolean";
  return type === "choice" ? { type: "text" } : { type, unit: answer?.unit };
}

function onePerName(names: readonly Parameter[]): readonly Parameter[] {
  const first = new Map<string, Parameter>();
  for (const each of names) if (!first.has(each.name)) first.set(each.name, each);
  return [...first.values()];
}
