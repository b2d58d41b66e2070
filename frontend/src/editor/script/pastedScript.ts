/** Script that was copied elsewhere, put among the lines of the program's own. */
import { api, ApiProblem } from "@/api/client";
import { makeId } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { putWith } from "../state/putting";
import { doAndSay } from "../state/undoing";
import { say, select, useUi } from "../state/ui";
import type { NamedDevice } from "./completion";
import { pythonName } from "./names";
import { blockOf, functionsOf, indentOf, type Printed } from "./scriptLines";
import { type Chosen, withChosen } from "../edits/holes";
import { differenceOf, withFreshIds } from "./difference";
import { scriptWithChosen, strangersInScript } from "./strangers";
import type { DrawnScript } from "./session";

const GIVEN = /self\.(\p{ID_Continue}+)\s*=\s*(ctx\.\w+\([^\n]*\))/gu;
const NAMED = /\bself\.(\p{ID_Continue}+)/gu;
const CALL_OF_NEW_TASK = /^\s*self\.new_task\(\)\s*$/;

/** The program's script with the pasted lines behind a step, or at its end; null where nothing is to be pasted. */
export function scriptWith(
  text: string,
  { script, lines }: Printed,
  behind: string | null,
  devices: readonly NamedDevice[],
): string | null {
  const pasted = withOwnNames(text, script);
  const body = bodyOf(pasted.replaceAll("\t", "    ").split("\n"));
  if (body.length === 0) return null;
  const printed = script.split("\n");
  const spot = spotBehind(printed, lines, behind) ?? endOfNewTask(printed);
  const own = body.map((line) => (line.trim() ? " ".repeat(spot.indent) + line : ""));
  const run = printed.findLastIndex((line) => CALL_OF_NEW_TASK.test(line));
  const functions = missingFunctions(pasted.split("\n"), printed);
  const given = missingNames([...body, ...functions].join("\n"), script, pasted, devices);
  const defined = printed.findIndex((line) => /^ {4}def run\(/.test(line));
  const before = printed.slice(0, spot.at).filter((line, index) => !(index === spot.at - 1 && line.trim() === "pass"));
  const between = [...printed.slice(spot.at, defined), ...functions, ...printed.slice(defined, run)];
  return [...before, ...own, ...between, ...given, ...printed.slice(run)].join("\n");
}

/** What `run` gives each name: `ctx.get("oven01")`. */
function givenIn(script: string): Map<string, string> {
  return new Map([...script.matchAll(GIVEN)].map(([, name, what]) => [name ?? "", what ?? ""]));
}

/** What a name stands for whatever else is said of it: `get oven01`; nothing for any robot or a parameter. */
function meantBy(what: string | undefined): string | null {
  const said = /^ctx\.(get|place|zone)\(\s*["']([^"'\n]+)["']/.exec(what ?? "");
  return said ? `${said[1] ?? ""} ${said[2] ?? ""}` : null;
}

/**
 * The pasted lines with another name for the device, place or zone that they mean by one that the program gives to
 * something else: the name by which the program has the same, or a fresh one. So each step goes on driving its robot.
 */
function withOwnNames(pasted: string, script: string): string {
  const [ours, theirs] = [givenIn(script), givenIn(pasted)];
  const taken = new Set([...`${script}\n${pasted}`.matchAll(NAMED)].map(([, name]) => name));
  const others = new Map<string, string>();
  for (const [name, what] of theirs) {
    const meant = meantBy(what);
    if (meant === null || !ours.has(name) || meantBy(ours.get(name)) === meant) continue;
    const same = [...ours].find(([, each]) => meantBy(each) === meant)?.[0];
    let number = 2;
    while (taken.has(`${name}_${number}`)) number += 1;
    const other = same ?? `${name}_${number}`;
    taken.add(other);
    others.set(name, other);
  }
  return pasted.replace(NAMED, (whole, name: string) =>
    others.has(name) ? `self.${others.get(name) ?? name}` : whole,
  );
}

/** The lines of new_task of a whole script, else all lines; without what indents them all, and blank ends. */
function bodyOf(lines: readonly string[]): string[] {
  const start = lines.findIndex((line) => /^\s*def new_task\(/.test(line));
  const rest = start < 0 ? lines : lines.slice(start + 1);
  const end = start < 0 ? -1 : rest.findIndex((line) => /^\s*def /.test(line));
  const body = end < 0 ? rest : rest.slice(0, end);
  const indent = Math.min(...body.filter((line) => line.trim()).map(indentOf));
  const bare = body.map((line) => line.slice(Math.min(indent, indentOf(line))).trimEnd());
  const first = bare.findIndex(Boolean);
  return first < 0 ? [] : bare.slice(first, bare.findLastIndex(Boolean) + 1);
}

interface Spot {
  readonly at: number;
  readonly indent: number;
}

function spotBehind(printed: readonly string[], lines: readonly string[], step: string | null): Spot | null {
  const block = step ? blockOf(printed, lines, step) : null;
  return block ? { at: block.to, indent: indentOf(printed[block.from] ?? "") } : null;
}

function endOfNewTask(printed: readonly string[]): Spot {
  const start = printed.findIndex((line) => /^\s*def new_task\(/.test(line));
  const length = printed.slice(start + 1).findIndex((line) => !line.trim());
  return { at: start + 1 + (length < 0 ? printed.length - start - 1 : length), indent: 8 };
}

/** Functions that come with the pasted lines, and that the program has none of that name for. */
function missingFunctions(pasted: readonly string[], printed: readonly string[]): string[] {
  const own = functionsOf(printed);
  const theirs = [...functionsOf(pasted)].filter(([name]) => !OWN_FUNCTIONS.includes(name) && !own.has(name));
  return theirs.flatMap(([, lines]) => [...lines, ""]);
}

const OWN_FUNCTIONS = ["new_task", "run"];

/** The lines that `run` needs for names that it does not give yet. */
function missingNames(body: string, script: string, pasted: string, devices: readonly NamedDevice[]): string[] {
  const [known, theirs] = [givenIn(script), givenIn(pasted)];
  const used = new Set(
    [...body.matchAll(/self\.(\p{ID_Continue}+)(?!\p{ID_Continue}*\()/gu)].map(([, name]) => name ?? ""),
  );
  return [...used].flatMap((name) => {
    const device = devices.find((each) => pythonName(each.name) === name);
    const drives = new RegExp(`self\\.${name}\\.(move|pick|drop)\\(`).test(body);
    const what = theirs.get(name) ?? (device ? `ctx.get("${device.id}")` : drives ? "ctx.any()" : null);
    return known.has(name) || what === null ? [] : [`        self.${name} = ${what}`];
  });
}

/** Draw the pasted lines behind the selected step; devices that are not known here are asked for first. */
export function pasteScript(open: OpenProgram, pasted: string): void {
  const known = new Set(open.devices.map(({ id }) => id));
  putWith(
    strangersInScript(pasted, known),
    (chosen) => void drawPasted(open, scriptWithChosen(pasted, chosen), chosen),
  );
}

/** Draw the lines and say `done`, or why that cannot be; `chosen` stands in for devices that are not here. */
export async function drawPasted(open: OpenProgram, pasted: string, chosen: Chosen, done?: string): Promise<void> {
  const { compiled, shared, program, devices, t } = open;
  if (!compiled) return;
  const behind = useUi.getState().selected.at(-1) ?? null;
  const text = scriptWith(pasted, compiled, behind, devices);
  if (text === null) return;
  const base = shared.getDocument();
  try {
    const request = { text, base, shown: compiled.script };
    const drawn = await api.post<DrawnScript>(`/programs/${encodeURIComponent(program.id)}/script`, request);
    if (!drawn.document) {
      say(drawn.diagnostics[0]?.message ?? t("script.paste_again"));
      return;
    }
    const { document } = withFreshIds({ document: drawn.document, lines: drawn.lines }, base, makeId);
    const added = Object.keys(document.steps).filter((id) => !base.steps[id]);
    const draw = () => shared.apply(withChosen(differenceOf(base, document), chosen));
    if (done === undefined) draw();
    else doAndSay(open, draw, () => done);
    select(added);
  } catch (error) {
    if (!(error instanceof ApiProblem)) throw error;
    say(error.detail);
  }
}
