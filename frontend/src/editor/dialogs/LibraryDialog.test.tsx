// @vitest-environment jsdom
/** A function of the library is brought in once, and only where somebody still waits for it. */
import { act, fireEvent, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { readTree } from "@/program/document/tree";
import { show, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { applyEdits, type Edit } from "../edits/edits";
import { ProgramContext, type OpenProgram } from "../state/context";
import { resetUi, useUi } from "../state/ui";
import { LibraryDialog } from "./LibraryDialog";

testsPages();

const wait = (order: string): Step => ({ kind: "wait", place: ["program", "body", order], pos: [1, -1], params: {} });
const MIX = {
  id: "lib-1",
  name: "mix",
  version: 2,
  site: "hall",
  description: "Mixes",
  parameters: [],
  definition: { function: { name: "mix", parameters: [] }, functions: {}, steps: {}, roles: {}, zones: {} },
};
let document: ProgramDocument;

function opened() {
  document = { ...EMPTY_DOCUMENT, steps: { one: wait("A"), two: wait("B") } };
  const open = {
    document,
    site: { slug: "hall" },
    program: { id: "p" },
    canEdit: true,
    apply: (edits: readonly Edit[]) => (document = applyEdits(document, edits)),
    shared: { stored: () => Promise.resolve(), getDocument: () => document, undo: { next: () => null } },
    scene: { tree: readTree(document), chips: new Map(), frames: [], links: [], start: { x: 0, y: 0 } },
    devices: [],
    plan: null,
    t: (key: string) => key,
  } as unknown as OpenProgram;
  useUi.setState({ dialog: "library" });
  show(
    <ProgramContext value={open}>
      <LibraryDialog />
    </ProgramContext>,
  );
}

const kinds = () =>
  readTree(document)
    .children("program", "body")
    .map((id) => document.steps[id]?.kind);
const offered = async () => (await screen.findByText("mix v2")).closest("button") as HTMLButtonElement;

beforeEach(resetUi);

test("pressed twice it is brought in once, into the program as it is then", async () => {
  const server = slowServer({ [`&fits=hall`]: [MIX] });
  opened();
  const button = await offered();
  fireEvent.click(button);
  const version = await server.nth(1);
  expect(button.disabled).toBe(true);
  fireEvent.click(button);
  act(() => {
    useUi.setState({ into: { branch: { parent: "program", branch: "body" }, link: "", word: "" } });
    document = applyEdits(document, [{ do: "add_step", id: "three", step: { ...wait("C"), kind: "drop" } }]);
  });
  await version.answer(201, {});
  await waitFor(() => expect(useUi.getState().dialog).toBeNull());
  expect(kinds()).toEqual(["wait", "wait", "drop", "call"]);
  expect(server.waiting).toHaveLength(1);
});

test("nothing is brought in once the dialog has been closed", async () => {
  const server = slowServer({ [`&fits=hall`]: [MIX] });
  opened();
  fireEvent.click(await offered());
  const version = await server.nth(1);
  act(() => useUi.setState({ dialog: null }));
  await version.answer(201, {});
  expect(kinds()).toEqual(["wait", "wait"]);
});

test("what the server refuses is said, and the function can be chosen again", async () => {
  const server = slowServer({ [`&fits=hall`]: [MIX] });
  opened();
  const button = await offered();
  fireEvent.click(button);
  await (await server.nth(1)).answer(503);
  await waitFor(() => expect(useUi.getState().toast).not.toBeNull());
  expect([kinds(), button.disabled, useUi.getState().dialog]).toEqual([["wait", "wait"], false, "library"]);
});
