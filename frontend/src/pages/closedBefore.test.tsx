// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import type { LibraryFunction, Program, Site, Version } from "@/api/types";
import { RehearseDialog } from "@/shell/start/RehearseDialog";
import { RunDialog } from "@/shell/start/RunForm";
import { markTried } from "@/shell/triedSteps";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { BeginCard } from "./home/BeginCard";
import { StartCard } from "./home/StartCard";
import { CopyVersion } from "./history/CopyVersion";
import { NameVersion } from "./history/NameVersion";
import { SaveVersion } from "./history/SaveVersion";
import { CopyToSite } from "./library/CopyToSite";
import { NewProgramButton } from "./programs/NewProgram";
import { ProgramActions } from "./programs/ProgramActions";
import { PromoteProgram } from "./programs/PromoteProgram";

testsPages();

const noop = () => undefined;
const program = { id: "p", name: "Tour", site: "hall" } as Program;
const version = { number: 2, name: "Draft", message: "" } as Version;
const HALL = { slug: "hall", name: "Hall", role: "author", simulated: true, stop: { active: false } } as Site;
const YARD = { ...HALL, slug: "yard", name: "Yard" };
const MAPPED = { ...HALL, slug: "mapped", has_map: true, robots: 1, machines: 0 } as Site;
const item = { id: "f", name: "Fetch", version: 1, site: "hall" } as LibraryFunction;
const document = { steps: {}, roles: {}, parameters: {} } as never;
const stored = () => Promise.resolve();
const about = { program, site: HALL, document, compiled: null, devices: [], places: [], version: null, stored };
const me = { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } };
const KNOWN = {
  "/api/me": me,
  "/sites/hall": HALL,
  "/review": { needed: 0, history: [], may_run: true },
};
const FLOOR = { version: 1, tag: "one", width: 1, height: 1, resolution_m: 1, origin: { x: 0, y: 0 } };
const DOCK = { id: "dock", name: "Dock", kind: "dock", x: 0, y: 0 };
const MAP = { ...FLOOR, cells: new Uint8Array([0]), places: [DOCK], zones: [] };

const press = async (words: string) => fireEvent.click(await screen.findByText(words, { selector: "button *" }));
const choose = async (words: string) => {
  fireEvent.click(screen.getByLabelText("Tour: more"));
  fireEvent.click(await screen.findByText(words));
};

const renames = async () => {
  await choose("Rename");
  await press("Rename");
};
const deletes = async () => {
  await choose("Delete");
  await press("Delete");
};
const makes = async () => {
  await press("New program");
  await press("Create and open");
};
const saves = async () => {
  await press("Save version");
  await press("Save");
};

test.each([
  ["a run", () => <RunDialog opened about={about} errors={0} warnings={0} onClose={noop} />, () => press("Run")],
  [
    "a rehearsal",
    () => <RehearseDialog opened about={about} onClose={noop} onStarted={noop} />,
    () => press("Simulate"),
  ],
  ["a name of a version", () => <NameVersion {...{ version, program }} onClose={noop} />, () => press("Save")],
  [
    "a copy of a version",
    () => <CopyVersion {...{ version, program }} onClose={noop} />,
    () => press("Copy as a new program"),
  ],
  ["a copy of a function", () => <CopyToSite slug="hall" item={item} onClose={noop} />, () => press("Copy")],
  ["a first program", () => <BeginCard site={HALL} />, () => press("Continue the demo")],
  ["a site's first program", () => <StartCard site={MAPPED} otherwise={null} />, () => press("Draw a program")],
  ["another name of a program", () => <ProgramActions program={program} />, renames],
  ["the end of a program", () => <ProgramActions program={program} />, deletes],
  [
    "a program for another site",
    () => <PromoteProgram program={program} onClose={noop} />,
    () => press("Make it at Yard"),
  ],
  ["a new program", () => <NewProgramButton slug="hall" />, makes],
  ["a version", () => <SaveVersion program={program} />, saves],
])("who has left before %s is refused is told", async (_, form, go) => {
  const { nth } = slowServer(KNOWN);
  vi.stubGlobal("Path2D", class { rect() {} }); // prettier-ignore
  markTried("map");
  const queries = makeQueryClient();
  queries.setQueryData(keys.map("hall"), null);
  queries.setQueryData(keys.map("mapped"), MAP);
  queries.setQueryData(keys.sites, [HALL, YARD]);
  queries.setQueryData(["promotion", "p", "yard"], { bindings: [], points: 0, zones: 0 });
  const { leave } = showWithCorner(form(), queries);
  await go();
  const asked = await nth(1);
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});
