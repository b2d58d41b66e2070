/**
 * Whole small programs to begin with, bound to the devices that a site has by what these can do; pure. A template is
 * written as script, since what is pasted as script is drawn and can be undone as one gesture.
 */
import { isRobot } from "@/map/devices/device";
import type { MapPlace } from "@/map/floor/floor";
import type { Place } from "@/program/document/document";
import { operable } from "@/program/operation";
import type { Method, MethodParameter, Property, SiteDevice } from "@/program/surroundings";
import { pythonName, RESERVED } from "../script/names";

export interface TemplateSite {
  readonly devices: readonly SiteDevice[];
  readonly places: readonly MapPlace[];
}

/** What can stand in a slot: a machine, or a named place. */
export interface Candidate {
  readonly id: string;
  readonly name: string;
  readonly place: Place;
}

export interface Slot {
  /** `first.templates.slot.<name>` in the catalogues. */
  readonly name: string;
  readonly candidates: readonly Candidate[];
}

export interface Bound {
  readonly script: string;
  /** Where the robot drives, in order. */
  readonly stops: readonly Candidate[];
  /** One line for each thing that is done: a key of `first.templates.does`, and its values; the stop where it is done. */
  readonly does: readonly {
    readonly key: string;
    readonly values: Readonly<Record<string, string>>;
    readonly stop: number;
  }[];
}

export interface Template {
  /** `first.templates.<id>` in the catalogues. */
  readonly id: string;
  readonly icon: string;
  /** The slots, each with what fits beside what was chosen before it; a slot without candidates: the site lacks it. */
  readonly slots: (site: TemplateSite, chosen: Chosen) => readonly Slot[];
  /** What it is, once every slot is filled. */
  readonly bind: (site: TemplateSite, chosen: Chosen) => Bound;
}

export type Chosen = Readonly<Record<string, string>>;

function machines({ devices }: TemplateSite): SiteDevice[] {
  return devices.filter((each) => !isRobot(each) && each.lifecycle !== "pending");
}

function asCandidate({ id, name }: SiteDevice): Candidate {
  return { id, name, place: { device: id } };
}

function slot(name: string, found: readonly SiteDevice[]): Slot {
  return { name, candidates: found.map(asCandidate) };
}

/** The device that fills a slot: the chosen one while it fits, else the first that does. */
export function filled(slots: readonly Slot[], name: string, chosen: Chosen): Candidate | undefined {
  const candidates = slots.find((each) => each.name === name)?.candidates ?? [];
  return candidates.find(({ id }) => id === chosen[name]) ?? candidates[0];
}

function device(site: TemplateSite, id: string | undefined): SiteDevice | undefined {
  return site.devices.find((each) => each.id === id);
}

/** Where things come in stands first: it gives and does not take. */
function sources(site: TemplateSite): SiteDevice[] {
  const giving = machines(site).filter((each) => each.gives.length > 0);
  return [...giving.filter((each) => each.takes.length === 0), ...giving.filter((each) => each.takes.length > 0)];
}

/** Where what a machine gives can go, where it ends first: it takes and does not give. */
function targets(site: TemplateSite, from: SiteDevice | undefined): SiteDevice[] {
  const taking = machines(site).filter((each) => each.id !== from?.id && shared(from, each) !== undefined);
  return [...taking.filter((each) => each.gives.length === 0), ...taking.filter((each) => each.gives.length > 0)];
}

/** An object that one gives and the other takes. */
function shared(from: SiteDevice | undefined, to: SiteDevice | undefined): string | undefined {
  return from?.gives.find((object) => to?.takes.includes(object));
}

function fetchSlots(site: TemplateSite, chosen: Chosen): Slot[] {
  const from = slot(
    "source",
    sources(site).filter((each) => targets(site, each).length > 0),
  );
  const source = device(site, filled([from], "source", chosen)?.id);
  return [from, slot("target", source ? targets(site, source) : [])];
}

/** The machines that a template has chosen, by their slots. */
function chosenDevices(site: TemplateSite, slots: readonly Slot[], chosen: Chosen): (name: string) => SiteDevice {
  return (name) => {
    const found = device(site, filled(slots, name, chosen)?.id);
    if (!found) throw new Error(`The slot ${name} of the template is empty.`);
    return found;
  };
}

type Named = SiteDevice | MapPlace;
type NameOf = (thing: Named) => string;

/** What each thing is called behind `self.`: by its name, and by its id, too, where the name alone is not enough. */
function namesOf({ devices, places }: TemplateSite): NameOf {
  const all = [...devices.filter((each) => !isRobot(each)), ...places].map(({ name }) => pythonName(name));
  const counted = new Map<string, number>();
  for (const name of all) counted.set(name, (counted.get(name) ?? 0) + 1);
  return ({ id, name }) => {
    const short = pythonName(name);
    return RESERVED.has(short) || (counted.get(short) ?? 0) > 1 ? `${short}_${pythonName(id)}` : short;
  };
}

function fetchLines(nameOf: NameOf, from: SiteDevice, to: SiteDevice): string[] {
  const load = `{"value": 1, "object": ${JSON.stringify(shared(from, to) ?? "")}}`;
  const [source, target] = [nameOf(from), nameOf(to)];
  return [
    `self.robot.move(self.${source}.location)`,
    `self.robot.pick(${load})`,
    `self.robot.move(self.${target}.location)`,
    `self.robot.drop(${load})`,
  ];
}

function fetchDoes(from: SiteDevice, to: SiteDevice, stop: number): Bound["does"] {
  const object = shared(from, to) ?? "";
  return [
    { key: "pick", values: { object, place: from.name }, stop },
    { key: "drop", values: { object, place: to.name }, stop: stop + 1 },
  ];
}

/** The whole script: what is done, and who is who. */
function scriptOf(nameOf: NameOf, lines: readonly string[], used: readonly Named[]): string {
  const given = used.map((each) => {
    const by = "device_class" in each ? `ctx.get(${JSON.stringify(each.id)})` : `ctx.place(${JSON.stringify(each.id)})`;
    return `self.${nameOf(each)} = ${by}`;
  });
  const robot = lines.some((line) => line.includes("self.robot.")) ? ["self.robot = ctx.any()"] : [];
  const indented = (each: readonly string[]) => each.map((line) => `        ${line}`);
  return [
    "class Task(object):",
    "    def new_task(self):",
    ...indented(lines),
    "",
    "    def run(self, ctx):",
    ...indented([...robot, ...new Set(given), "self.new_task()"]),
  ].join("\n");
}

const fetch: Template = {
  id: "fetch",
  icon: "pickdrop",
  slots: fetchSlots,
  bind: (site, chosen) => {
    const at = chosenDevices(site, fetchSlots(site, chosen), chosen);
    const [from, to] = [at("source"), at("target")];
    const nameOf = namesOf(site);
    return {
      script: scriptOf(nameOf, fetchLines(nameOf, from, to), [from, to]),
      stops: [from, to].map(asCandidate),
      does: fetchDoes(from, to, 0),
    };
  },
};

/** A value that a method takes for sure, where it can be known: its least, or the first of its options. */
function sureValue({ minimum, options, type }: MethodParameter): string | undefined {
  const [option] = options ?? [];
  if (option !== undefined) return JSON.stringify(option);
  if (typeof minimum === "number") return String(minimum);
  return type === "number" ? "1" : undefined;
}

/** The first method of a machine whose values are all known. */
function sureMethod(machine: SiteDevice): { method: Method; args: string } | undefined {
  for (const method of operable(machine)) {
    const values = method.parameters.map((each) => [each.name, sureValue(each)] as const);
    if (values.every(([, value]) => value !== undefined))
      return { method, args: values.map(([name, value]) => `${JSON.stringify(name)}: ${value}`).join(", ") };
  }
  return undefined;
}

function processSlots(site: TemplateSite, chosen: Chosen): Slot[] {
  const works = (from: SiteDevice) =>
    targets(site, from).filter((each) => sureMethod(each) && targets(site, each).some(({ id }) => id !== from.id));
  const from = slot(
    "source",
    sources(site).filter((each) => works(each).length > 0),
  );
  const source = device(site, filled([from], "source", chosen)?.id);
  const worker = slot("machine", source ? works(source) : []);
  const machine = device(site, filled([worker], "machine", chosen)?.id);
  const onward = machine ? targets(site, machine).filter(({ id }) => id !== source?.id) : [];
  return [from, worker, slot("target", onward)];
}

const process: Template = {
  id: "process",
  icon: "operate",
  slots: processSlots,
  bind: (site, chosen) => {
    const at = chosenDevices(site, processSlots(site, chosen), chosen);
    const [from, machine, to] = [at("source"), at("machine"), at("target")];
    const nameOf = namesOf(site);
    const { method, args } = sureMethod(machine) ?? { method: { name: "", parameters: [] }, args: "" };
    const work = `self.${nameOf(machine)}.operate(${JSON.stringify(method.name)}, {${args}})`;
    return {
      script: scriptOf(
        nameOf,
        [...fetchLines(nameOf, from, machine), work, ...fetchLines(nameOf, machine, to)],
        [from, machine, to],
      ),
      stops: [from, machine, to].map(asCandidate),
      does: [
        ...fetchDoes(from, machine, 0),
        { key: "operate", values: { method: method.title || method.name, place: machine.name }, stop: 1 },
        ...fetchDoes(machine, to, 1),
      ],
    };
  },
};

const ROUND = 3;

/** Named places to drive to; rooms where nothing smaller has a name, machines where nothing has. */
function goals(site: TemplateSite): (Candidate & { readonly of: SiteDevice | MapPlace })[] {
  const places = site.places.filter((each) => each.kind !== "dock" && each.kind !== "charger");
  const named = places.map((of) => ({ id: of.id, name: of.name, place: { place: of.id }, of }));
  if (named.length >= 2) return named;
  return machines(site).map((of) => ({ ...asCandidate(of), of }));
}

function patrolSlots(site: TemplateSite, chosen: Chosen): Slot[] {
  const all = site.devices.some(isRobot) ? goals(site) : [];
  const slots: Slot[] = [];
  for (let index = 1; index <= Math.max(2, Math.min(ROUND, all.length)); index += 1) {
    const taken = slots.map(({ name }) => filled(slots, name, chosen)?.id);
    slots.push({ name: `stop${index}`, candidates: all.filter(({ id }) => !taken.includes(id)) });
  }
  return slots;
}

const patrol: Template = {
  id: "patrol",
  icon: "repeat",
  slots: patrolSlots,
  bind: (site, chosen) => {
    const slots = patrolSlots(site, chosen);
    const stops = slots.flatMap(
      ({ name }) => goals(site).find(({ id }) => id === filled(slots, name, chosen)?.id) ?? [],
    );
    const nameOf = namesOf(site);
    const moves = stops.map(({ of }) => `    self.robot.move(self.${nameOf(of)}.location)`);
    return {
      script: scriptOf(
        nameOf,
        ["for _ in range(3):", ...moves],
        stops.map(({ of }) => of),
      ),
      stops: stops.map(({ id, name, place }) => ({ id, name, place })),
      does: stops.map(({ name }, stop) => ({ key: "drive", values: { place: name }, stop })),
    };
  },
};

/** What a machine reports as a number, those that count things first. */
function figure({ properties }: SiteDevice): Property | undefined {
  const numbers = properties.filter(({ type, name }) => type === "number" && !/^(job|battery)/i.test(name));
  return numbers.find(({ unit }) => !unit) ?? numbers[0];
}

/** From which reading on something is done: one piece of what is counted, half of what is measured. */
function threshold({ unit, minimum, maximum }: Property): number {
  if (!unit || typeof maximum !== "number") return 1;
  return Math.round(((minimum ?? 0) + maximum) / 2);
}

function waitSlots(site: TemplateSite, chosen: Chosen): Slot[] {
  const watched = (each: SiteDevice) => figure(each) !== undefined && targets(site, each).length > 0;
  const from = slot("watched", sources(site).filter(watched));
  const source = device(site, filled([from], "watched", chosen)?.id);
  return [from, slot("target", source ? targets(site, source) : [])];
}

const wait: Template = {
  id: "wait",
  icon: "wait",
  slots: waitSlots,
  bind: (site, chosen) => {
    const at = chosenDevices(site, waitSlots(site, chosen), chosen);
    const [from, to] = [at("watched"), at("target")];
    const nameOf = namesOf(site);
    const read = figure(from);
    const value = String(read ? threshold(read) : 1);
    const until = `self.wait(until=self.${nameOf(from)}.${pythonName(read?.name ?? "")} >= ${value})`;
    return {
      script: scriptOf(nameOf, [until, ...fetchLines(nameOf, from, to)], [from, to]),
      stops: [from, to].map(asCandidate),
      does: [
        { key: "wait", values: { reading: read?.name ?? "", value, place: from.name }, stop: 0 },
        ...fetchDoes(from, to, 0),
      ],
    };
  },
};

const LOW_PERCENT = 30;

/** The reading of a robot that says how full its battery is. */
function battery(site: TemplateSite): string | undefined {
  const readings = site.devices.filter(isRobot).flatMap((each) => each.properties);
  return readings.find(({ name, type }) => type === "number" && /batter|charge/i.test(name))?.name;
}

function chargeSlots(site: TemplateSite, chosen: Chosen): Slot[] {
  const kinds = ["charger", "dock", "parking"];
  const at = site.places.filter(({ kind }) => kinds.includes(kind));
  const docks = battery(site) === undefined ? [] : at;
  return [
    ...fetchSlots(site, chosen),
    { name: "dock", candidates: docks.map(({ id, name }) => ({ id, name, place: { place: id } })) },
  ];
}

const charge: Template = {
  id: "charge",
  icon: "dock",
  slots: chargeSlots,
  bind: (site, chosen) => {
    const slots = chargeSlots(site, chosen);
    const at = chosenDevices(site, slots, chosen);
    const [from, to] = [at("source"), at("target")];
    const nameOf = namesOf(site);
    const dock = site.places.find(({ id }) => id === filled(slots, "dock", chosen)?.id);
    const lines = [
      ...fetchLines(nameOf, from, to),
      `if self.robot.${pythonName(battery(site) ?? "")} < ${LOW_PERCENT}:`,
      ...(dock ? [`    self.robot.move(self.${nameOf(dock)}.location)`] : []),
    ];
    return {
      script: scriptOf(nameOf, lines, [from, to, ...(dock ? [dock] : [])]),
      stops: [
        ...[from, to].map(asCandidate),
        ...(dock ? [{ id: dock.id, name: dock.name, place: { place: dock.id } }] : []),
      ],
      does: [
        ...fetchDoes(from, to, 0),
        { key: "charge", values: { value: String(LOW_PERCENT), place: dock?.name ?? "" }, stop: 2 },
      ],
    };
  },
};

export const TEMPLATES: readonly Template[] = [fetch, process, patrol, wait, charge];

/** The first slot that the site has nothing for; null where the template can be taken. */
export function lacking(slots: readonly Slot[]): Slot | null {
  return slots.find(({ candidates }) => candidates.length === 0) ?? null;
}
