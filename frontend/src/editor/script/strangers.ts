/** Devices and places of another site in pasted script: who they are, and the script with others in their stead. Pure. */
import { ROBOT_STEPS } from "@/program/operation";
import type { Chosen, Stranger } from "../edits/holes";
import { codeOf, inCode, QUOTED } from "./pieces";

/** Parts of a device that are written like readings, and that every device has. */
const OWN_PARTS = ["location"];
/** Calls that need no description of who carries them out. */
const PLAIN = ["operate", "read"];
/** Calls of robots alone, beside those that a machine may have, too. */
const OF_ROBOTS = [...ROBOT_STEPS, "cover"];

/** Where a line of a tidied script says an id: what stands before it, the name that is given, and the id in quotes. */
const FORMS = {
  get: String.raw`^(\s*self\.(NAME)\s*=\s*ctx\.get\(\s*)(QUOTED)`,
  place: String.raw`^(\s*self\.(NAME)\s*=\s*ctx\.place\(\s*)(QUOTED)`,
  parameter: String.raw`^(\s*self\.(NAME)\s*=\s*ctx\.parameter\(\s*QUOTED\s*,\s*)(QUOTED)(?=\s*,\s*Device\b)`,
  door: String.raw`^(\s*self\.(NAME)\s*=\s*ctx\.zone\(.*\bdoor\s*=\s*)(QUOTED)`,
  argument: String.raw`(?<=^\s*def .*)(\b(NAME)\s*:\s*Device\s*=\s*)(QUOTED)`,
} as const;
type Form = keyof typeof FORMS;
const PATTERNS = Object.entries(FORMS).map(([form, text]) => {
  const pattern = text.replaceAll("NAME", String.raw`\p{ID_Continue}+`).replaceAll("QUOTED", QUOTED);
  return [form as Form, new RegExp(pattern, "gu")] as const;
});

interface Mention {
  readonly form: Form;
  readonly name: string;
  readonly id: string;
}

/** The script with other ids, in quotes, where `other` has them. */
function withIds(script: string, other: (mention: Mention) => string | undefined): string {
  const changed = (line: string, [form, pattern]: (typeof PATTERNS)[number]) =>
    line.replace(pattern, (whole, before: string, name: string, quoted: string) => {
      const next = other({ form, name, id: quoted.slice(1, -1) });
      return next === undefined ? whole : before + next;
    });
  return script
    .split("\n")
    .map((line) => PATTERNS.reduce(changed, line))
    .join("\n");
}

/** The devices and places that the script names by an id that is not known here, with what it does with them. */
export function strangersInScript(
  script: string,
  devices: ReadonlySet<string>,
  places: ReadonlySet<string>,
): Stranger[] {
  const found = new Map<string, Stranger>();
  withIds(script, ({ form, name, id }) => {
    const kind = form === "place" ? "place" : "device";
    const needs = form === "door" ? { ...needsOf(script, ""), methods: ["open"] } : needsOf(script, name, form);
    const known = kind === "place" ? places : devices;
    if (!known.has(id)) found.set(id, { kind, id, name: id, needs: bothOf(found.get(id)?.needs, needs) });
    return undefined;
  });
  return [...found.values()];
}

function bothOf(one: Stranger["needs"] | undefined, other: Stranger["needs"]): Stranger["needs"] {
  if (!one) return other;
  return {
    ...other,
    robot: one.robot || other.robot,
    methods: unique([...one.methods, ...other.methods]),
    readings: unique([...one.readings, ...other.readings]),
  };
}

function needsOf(script: string, name: string, form?: Form): Stranger["needs"] {
  if (form === "place" || name === "") return { robot: false, methods: [], gives: [], takes: [], readings: [] };
  const mention = String.raw`(?<![\p{ID_Continue}.])${form === "argument" ? "" : String.raw`self\.`}${name}\.`;
  const all = (text: string, rest: string) =>
    [...text.matchAll(new RegExp(mention + rest, "gu"))].map(([, member = ""]) => member);
  const code = codeOf(script);
  const called = unique(all(code, String.raw`(\p{ID_Continue}+)\(`));
  const read = [
    ...all(code, String.raw`(\p{ID_Continue}+)(?![\p{ID_Continue}(])`),
    ...all(script, String.raw`read\(\s*(${QUOTED})`).map((quoted) => quoted.slice(1, -1)),
  ];
  return {
    robot: OF_ROBOTS.some((each) => called.includes(each)) || isSaidRobot(script, name),
    methods: called.filter((each) => !PLAIN.includes(each)),
    gives: [],
    takes: [],
    readings: unique(read.filter((each) => !OWN_PARTS.includes(each))),
  };
}

function isSaidRobot(script: string, name: string): boolean {
  return new RegExp(String.raw`^\s*self\.${name}\s*=\s*ctx\.get\(.*\bkind\s*=\s*["']robot["']`, "mu").test(script);
}

function unique(names: readonly string[]): string[] {
  return [...new Set(names)];
}

/**
 * The script with the ids that were chosen. What is left open keeps its id and says its methods and readings in the form
 * that needs no description, methods without their values: the steps are drawn so, and their device is taken out of them
 * then. Where a device is the value that a parameter has, there is none.
 */
export function scriptWithChosen(script: string, chosen: Chosen): string {
  const open = new Set<string>();
  const text = withIds(script, ({ form, name, id }) => {
    const other = chosen.get(id);
    if (typeof other === "string") return JSON.stringify(other);
    if (other === null && form === "get") open.add(name);
    return other === null && (form === "parameter" || form === "argument") ? "None" : undefined;
  });
  return [...open].reduce(undescribed, text);
}

function undescribed(script: string, name: string): string {
  const { robot } = needsOf(script, name);
  const kept = robot ? [...PLAIN, ...OF_ROBOTS, "release"] : PLAIN;
  const calls = new RegExp(
    String.raw`^(\s*self\.${name}\.)(?!(?:${kept.join("|")})\()(\p{ID_Continue}+)\(.*\)$`,
    "gmu",
  );
  const reading = new RegExp(
    String.raw`(?<![\p{ID_Continue}.])self\.${name}\.(\p{ID_Continue}+)(?![\p{ID_Continue}(])`,
    "gu",
  );
  return inCode(script.replace(calls, '$1operate("$2", {})'), (code) =>
    code.replace(reading, (whole, member: string) =>
      OWN_PARTS.includes(member) ? whole : `self.${name}.read("${member}")`,
    ),
  );
}
