/** Devices of another site in pasted script: who they are, and the script with others in their stead. Pure. */
import { ROBOT_STEPS } from "@/program/operation";
import type { Chosen, Stranger } from "../edits/holes";

const GET = /self\.(\p{ID_Continue}+)\s*=\s*ctx\.get\(\s*["']([^"']+)["']\s*\)/gu;
/** Parts of a device that are written like readings, and that every device has. */
const OWN_PARTS = ["location"];

/** The devices that the script gets by an id that is not known here, with what it does with them. */
export function strangersInScript(script: string, known: ReadonlySet<string>): Stranger[] {
  const found = new Map<string, Stranger>();
  for (const [, name = "", id = ""] of script.matchAll(GET))
    if (!known.has(id)) found.set(id, { kind: "device", id, name: id, needs: needsOf(script, name) });
  return [...found.values()];
}

function needsOf(script: string, name: string): Stranger["needs"] {
  const members = [...script.matchAll(new RegExp(`self\\.${name}\\.(\\p{ID_Continue}+)(\\(?)`, "gu"))];
  const called = unique(members.filter(([, , open]) => open !== "").map(([, member = ""]) => member));
  const read = unique(members.filter(([, , open]) => open === "").map(([, member = ""]) => member));
  const robot = ROBOT_STEPS.some((each) => called.includes(each));
  return {
    robot,
    methods: called.filter((each) => each !== "operate"),
    gives: [],
    takes: [],
    readings: read.filter((each) => !OWN_PARTS.includes(each)),
  };
}

function unique(names: readonly string[]): string[] {
  return [...new Set(names)];
}

/**
 * The script with the ids that were chosen. What is left open keeps its id and says its methods in the form that needs
 * no description, without their values: the steps are drawn so, and their device is taken out of them then.
 */
export function scriptWithChosen(script: string, chosen: Chosen): string {
  let text = script;
  for (const [, name = "", id = ""] of script.matchAll(GET)) {
    const other = chosen.get(id);
    if (other === null)
      text = text.replace(
        new RegExp(`self\\.${name}\\.(?!operate\\()(\\p{ID_Continue}+)\\([^\\n]*\\)`, "gu"),
        `self.${name}.operate("$1", {})`,
      );
    else if (other !== undefined)
      text = text.replace(GET, (line, own: string, given: string) =>
        own === name && given === id ? line.replace(id, other) : line,
      );
  }
  return text;
}
