// @vitest-environment jsdom
/** A toast offers Undo for what it tells of, and for nothing else. */
import "fake-indexeddb/auto";
import { act, cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test } from "vitest";
import { EDIT_COMMANDS } from "../commands/editing";
import type { On } from "../commands/command";
import type { Edit } from "../edits/edits";
import { applyEditsToDoc, SharedProgram } from "../shared/sharedProgram";
import { nudgeSelected } from "../state/actions";
import { type OpenProgram, ProgramContext } from "../state/context";
import { resetUi, select } from "../state/ui";
import { goBack } from "../state/undoing";
import { Toast } from "./Overlays";

const STEP = { kind: "wait", place: ["program", "body", "A"], pos: [1, -1], params: { duration: 1 } } as const;
let shared: SharedProgram;

const open = () => {
  const apply = (edits: readonly Edit[]) => shared.apply(edits);
  const scene = { frames: [] };
  return { shared, apply, scene, document: shared.getDocument(), t: (key: string) => key } as unknown as OpenProgram;
};
const run = (id: string) =>
  act(() => {
    EDIT_COMMANDS.find((each) => each.id === id)?.run(open(), {} as On);
  });
const others = (edit: Edit) => act(() => applyEditsToDoc(shared.doc, [edit], "somebody else"));
const step = (id: string) => shared.getDocument().steps[id];
const buttons = () => screen.queryAllByRole("button").map(({ textContent }) => textContent);

beforeEach(() => {
  shared = new SharedProgram("p", "ws://nowhere.invalid", "1");
  shared.provider.emit("sync", [true]);
  applyEditsToDoc(
    shared.doc,
    ["a", "b"].map((id): Edit => ({ do: "add_step", id, step: STEP })),
  );
  resetUi();
  select(["a"]);
  render(
    <ProgramContext value={open()}>
      <Toast />
    </ProgramContext>,
  );
});
afterEach(() => {
  cleanup();
  shared.close();
});

test("Undo in the toast brings the removed step back", () => {
  run("delete");
  expect(step("a")).toBeUndefined();
  fireEvent.click(screen.getByText("undo"));
  expect(step("a")).toEqual(STEP);
  expect(screen.queryByRole("status")).toBeNull();
});

test("once something else would be undone, the toast offers no Undo any more", () => {
  run("delete");
  expect(buttons()).toEqual(["undo"]);
  act(() => select(["b"]));
  act(() => nudgeSelected(open(), [0.1, 0]));
  expect(screen.getByRole("status").textContent).toBe("removed");
  expect(buttons()).toEqual([]);
  expect(step("b")?.pos).toEqual([1.1, -1]);
});

test("after it was undone by key, what was done before it is not offered", () => {
  act(() => nudgeSelected(open(), [0.1, 0]));
  run("delete");
  act(() => goBack(open(), "undo"));
  expect(buttons()).toEqual([]);
  expect(step("a")?.pos).toEqual([1.1, -1]);
});

test("a question about Redo offers Redo, and goes when nobody can answer it any more", () => {
  act(() => nudgeSelected(open(), [0.1, 0]));
  run("undo");
  others({ do: "set_pos", id: "a", pos: [7, 7] });
  run("redo");
  expect(screen.getByRole("status").textContent).toBe("gesture.overwritten_redoredo");
  fireEvent.click(screen.getByText("redo"));
  expect(step("a")?.pos).toEqual([1.1, -1]);
  run("undo");
  others({ do: "set_pos", id: "a", pos: [7, 7] });
  run("redo");
  act(() => select(["b"]));
  act(() => nudgeSelected(open(), [0.1, 0]));
  expect(screen.queryByRole("status")).toBeNull();
});
