/** What can stand at the cursor: devices, what they do and report, robots' verbs, functions and names of the task. */
import type { Completion, CompletionContext, CompletionResult } from "@codemirror/autocomplete";
import type { EditorView } from "@codemirror/view";
import { STEP_KINDS } from "@/program/kinds";
import { pythonName } from "./names";

export interface NamedDevice {
  readonly id: string;
  readonly name: string;
  readonly kind: string;
  readonly methods: readonly { readonly name: string; readonly parameters: readonly { readonly name: string }[] }[];
  readonly properties: readonly { readonly name: string; readonly unit?: string | null }[];
}

export interface Option {
  readonly label: string;
  readonly detail: string;
  readonly kind: "device" | "robot" | "method" | "property" | "function" | "verb" | "value";
  /** A device that `run` does not give yet. */
  readonly give?: string;
}

const CALLED = STEP_KINDS.filter((each) => each.method);
const VERBS = [...CALLED.filter((each) => !each.drives).map((each) => each.method ?? ""), "parallel", "limit"];
const ROBOT_VERBS = CALLED.filter((each) => each.drives).map((each) => each.method ?? "");
const GIVERS = ["get", "any", "place", "parameter", "zone", "when", "start_when"];
const WORDS = [
  "self",
  "if",
  "else",
  "while",
  "for",
  "try",
  "except",
  "finally",
  "return",
  "raise",
  "with",
  "break",
  "continue",
  "pass",
];
const GIVEN = /self\.(\p{ID_Continue}+)\s*=\s*ctx\.(\w+)\(\s*(?:["']([^"']*)["'])?/gu;
const DEFINED = /^ {4}def (\p{ID_Continue}+)\(self(?:,\s*([^)]*))?\)/gmu;
const SET = /^\s+self\.(\p{ID_Continue}+)\s*=(?!=)/gmu;
const NOT_FUNCTIONS = /^(run|new_task|branch_.*|when_.*)$/;

/** The options behind what stands before the cursor, and where the word begins that they complete; null: none. */
export function optionsAt(
  before: string,
  script: string,
  devices: readonly NamedDevice[],
): { readonly start: number; readonly options: readonly Option[] } | null {
  const line = before.slice(before.lastIndexOf("\n") + 1);
  const member = /self\.(\p{ID_Continue}+)\.(\p{ID_Continue}*)$/u.exec(line);
  if (member) return found(before, member[2], membersOf(member[1] ?? "", script, devices));
  const own = /self\.(\p{ID_Continue}*)$/u.exec(line);
  if (own) return found(before, own[1], ownNames(script, devices));
  const giver = /ctx\.(\w*)$/.exec(line);
  if (giver) return found(before, giver[1], plain(GIVERS, "verb"));
  const id = /ctx\.get\(["']([\w.-]*)$/.exec(line);
  if (id) return found(before, id[1], idsOf(devices));
  const word = /^\s+(\p{ID_Continue}+)$/u.exec(line);
  return word ? found(before, word[1], plain(WORDS, "value")) : null;
}

function found(before: string, word: string | undefined, options: readonly Option[]) {
  return { start: before.length - (word ?? "").length, options };
}

function plain(names: readonly string[], kind: Option["kind"]): Option[] {
  return names.map((label) => ({ label, detail: "", kind }));
}

function idsOf(devices: readonly NamedDevice[]): Option[] {
  return devices.map(({ id, name }) => ({ label: id, detail: name, kind: "device" }));
}

function given(script: string): Map<string, { kind: string; id: string }> {
  return new Map(
    [...script.matchAll(GIVEN)].map(([, name, kind, id]) => [name ?? "", { kind: kind ?? "", id: id ?? "" }]),
  );
}

function ownNames(script: string, devices: readonly NamedDevice[]): Option[] {
  const names = given(script);
  const ids = new Set([...names.values()].map(({ id }) => id));
  const known = [...names].map(([label, { kind, id }]): Option => {
    const device = devices.find((each) => each.id === id);
    const robot = kind === "any" || device?.kind === "robot";
    const sort = robot ? "robot" : kind === "get" || kind === "place" ? "device" : "value";
    return { label, detail: device?.name ?? "", kind: sort };
  });
  const others = devices
    .filter((device) => !ids.has(device.id))
    .map((device): Option => {
      const label = freeName(pythonName(device.name), names);
      return { label, detail: device.name, kind: device.kind === "robot" ? "robot" : "device", give: device.id };
    });
  const functions = [...script.matchAll(DEFINED)]
    .filter(([, name]) => name && !NOT_FUNCTIONS.test(name))
    .map(([, name, parameters]): Option => ({ label: name ?? "", detail: `(${parameters ?? ""})`, kind: "function" }));
  const variables = [...new Set([...script.matchAll(SET)].map(([, name]) => name ?? ""))]
    .filter((name) => !names.has(name))
    .map((label): Option => ({ label, detail: "", kind: "value" }));
  return [...known, ...functions, ...variables, ...plain(VERBS, "verb"), ...others];
}

function freeName(wanted: string, taken: ReadonlyMap<string, unknown>): string {
  let [name, number] = [wanted, 2];
  while (taken.has(name)) name = `${wanted}_${number++}`;
  return name;
}

function membersOf(name: string, script: string, devices: readonly NamedDevice[]): Option[] {
  const binding = given(script).get(name);
  const device = devices.find((each) => each.id === binding?.id);
  if (binding?.kind === "any" || device?.kind === "robot") {
    const robots = device ? [device] : devices.filter((each) => each.kind === "robot");
    return [...plain(ROBOT_VERBS, "verb"), ...methodsOf(robots), ...propertiesOf(robots)];
  }
  return [
    ...methodsOf(device ? [device] : []),
    ...propertiesOf(device ? [device] : []),
    ...plain(["location"], "value"),
  ];
}

/** What these devices do; a robot's steps stand apart, and what several robots do stands there once. */
function methodsOf(devices: readonly NamedDevice[]): Option[] {
  const found = new Map<string, Option>();
  for (const device of devices)
    for (const { name, parameters } of device.methods) {
      const label = pythonName(name);
      if (found.has(label) || (device.kind === "robot" && ROBOT_VERBS.includes(name))) continue;
      found.set(label, { label, detail: `(${parameters.map((each) => each.name).join(", ")})`, kind: "method" });
    }
  return [...found.values()];
}

/** What these devices report; what several robots report stands there once. */
function propertiesOf(devices: readonly NamedDevice[]): Option[] {
  const found = new Map<string, Option>();
  for (const { name, unit } of devices.flatMap((each) => each.properties)) {
    const label = pythonName(name);
    if (!found.has(label)) found.set(label, { label, detail: unit ?? "", kind: "property" });
  }
  return [...found.values()];
}

/** CodeMirror's source of completions; a device that `run` does not give yet is given there, too. */
export function completeScript(devices: () => readonly NamedDevice[]) {
  return (context: CompletionContext): CompletionResult | null => {
    const script = context.state.doc.toString();
    const here = optionsAt(script.slice(0, context.pos), script, devices());
    if (!here || (here.start === context.pos && !context.explicit && !/\.$/.test(script.slice(0, context.pos))))
      return null;
    return { from: here.start, options: here.options.map(asCompletion), validFor: /^\p{ID_Continue}*$/u };
  };
}

function asCompletion({ label, detail, kind, give }: Option): Completion {
  const shown = { label, detail, type: kind };
  if (give === undefined) return shown;
  return { ...shown, boost: -1, apply: (view, _completion, from, to) => applyGiving(view, label, give, from, to) };
}

function applyGiving(view: EditorView, name: string, device: string, from: number, to: number): void {
  const script = view.state.doc.toString();
  const calls = [...script.matchAll(/^([ \t]*)self\.new_task\(\)[ \t]*$/gm)];
  const last = calls.at(-1);
  const word = { from, to, insert: name };
  const at = last?.index;
  const line = `${last?.[1] ?? ""}self.${name} = ctx.get("${device}")\n`;
  const changes = at === undefined ? [word] : [word, { from: at, insert: line }];
  const shift = at !== undefined && at <= from ? line.length : 0;
  view.dispatch({ changes, selection: { anchor: from + shift + name.length }, userEvent: "input.complete" });
}
