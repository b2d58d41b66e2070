/** Script that was copied elsewhere, put among the lines of the program's own. */
import { api, ApiProblem } from "@/api/client";
import { makeId } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { putWith } from "../state/putting";
import { doAndSay } from "../state/undoing";
import { say, select, useUi } from "../state/ui";
import type { NamedDevice } from "./completion";
import { pythonName } from "./names";
import { lastChosen } from "@/program/document/called";
import { ROBOT_STEPS } from "@/program/operation";
import { blockOf, indentOf, type Printed } from "./scriptLines";
import { type Chosen, withChosen } from "../edits/holes";
import { differenceOf, withFreshIds } from "./difference";
import { withFirstMoves } from "./firstMoves";
import { type Brought, broughtInto } from "./pastedNames";
import { atMargin, codeOf, methodsOf, tidied } from "./pieces";
import { partsOf } from "./scriptParts";
import { scriptWithChosen, strangersInScript } from "./strangers";
import type { DrawnScript } from "./session";

const CALL_OF_NEW_TASK = /^\s*self\.new_task\(\)\s*$/;

/** The program's script with the pasted lines behind a step, or at its end; null where nothing is to be pasted. */
export function scriptWith(
  text: string,
  { script, lines }: Printed,
  behind: string | null,
  devices: readonly NamedDevice[],
): string | null {
  const brought = broughtInto(script, withFirstMoves(tidied(text)), devices);
  const body = bodyOf(brought.text);
  if (body.length === 0) return null;
  const printed = script.split("\n");
  const spot = spotBehind(printed, lines, behind) ?? endOfNewTask(printed);
  const own = body.map((line) => (line.trim() ? " ".repeat(spot.indent) + line : ""));
  const run = printed.findLastIndex((line) => CALL_OF_NEW_TASK.test(line));
  const methods = [...brought.methods.values()].flatMap((each) => [...each, ""]);
  const given = missingNames([...body, ...methods, ...brought.events].join("\n"), script, brought, devices);
  const added = [...given, ...brought.events].map((line) => `        ${line}`);
  const defined = printed.findIndex((line) => /^ {4}def run\(/.test(line));
  const before = printed.slice(0, spot.at).filter((line, index) => !(index === spot.at - 1 && line.trim() === "pass"));
  const between = [...printed.slice(spot.at, defined), ...methods, ...printed.slice(defined, run)];
  return [...before, ...own, ...between, ...added, ...printed.slice(run)].join("\n");
}

/** The lines of new_task of a whole script, else all lines; without what indents them all, and blank ends. */
function bodyOf(text: string): string[] {
  const body = atMargin(methodsOf(text).get("new_task")?.slice(1) ?? text.split("\n"), 0);
  const first = body.findIndex(Boolean);
  return first < 0 ? [] : body.slice(first, body.findLastIndex(Boolean) + 1);
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

/** The lines that `run` needs for names that it does not give yet. */
function missingNames(body: string, script: string, brought: Brought, devices: readonly NamedDevice[]): string[] {
  const { given, variables } = partsOf(script);
  const code = codeOf(body);
  const used = [...code.matchAll(/(?<![\p{ID_Continue}.])self\.(\p{ID_Continue}+)(?![\p{ID_Continue}(])/gu)];
  return [...new Set(used.map(([, name = ""]) => name))].flatMap((name) => {
    if (given.has(name)) return [];
    const said = brought.given.get(name) ?? (variables.has(name) ? null : guessed(name, code, devices));
    return said === null ? [] : [`self.${name} = ${said}`];
  });
}

/** What lines that do not say it may mean by a name: the device that is called so, or any robot where they drive it. */
function guessed(name: string, code: string, devices: readonly NamedDevice[]): string | null {
  if (new RegExp(`self\\.${name}\\s*=(?!=)`).test(code)) return null;
  const device = devices.find((each) => pythonName(each.name) === name);
  const drives = new RegExp(`self\\.${name}\\.(${ROBOT_STEPS.join("|")})\\(`).test(code);
  return device ? `ctx.get("${device.id}")` : drives ? "ctx.any()" : null;
}

/** Draw the pasted lines behind the selected step; devices that are not known here are asked for first. */
export function pasteScript(open: OpenProgram, text: string): void {
  const pasted = withFirstMoves(tidied(text));
  const idsOf = (all: readonly { readonly id: string }[] = []) => new Set(all.map(({ id }) => id));
  putWith(
    strangersInScript(pasted, idsOf(open.devices), idsOf(open.plan?.places)),
    (chosen) => void drawPasted(open, scriptWithChosen(pasted, chosen), chosen),
  );
}

/** Draw the lines and say `done`, or why that cannot be; `chosen` stands in for devices that are not here. */
export async function drawPasted(open: OpenProgram, pasted: string, chosen: Chosen, done?: string): Promise<void> {
  const { compiled, shared, program, devices, t } = open;
  if (!compiled) return;
  const base = shared.getDocument();
  const behind = lastChosen(base, useUi.getState().selected);
  const text = scriptWith(pasted, compiled, behind, devices);
  if (text === null) return;
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
