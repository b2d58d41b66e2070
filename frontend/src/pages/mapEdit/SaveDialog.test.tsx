// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { SaveDialog } from "./SaveDialog";

testsPages();

const MAP = { version: 1, tag: "one" };
const NO_CHANGE = {
  walls_gained_m2: 0,
  walls_lost_m2: 0,
  floor_gained_m2: 0,
  floor_lost_m2: 0,
  troubles: [],
  programs: [],
};
const SAVED = "Version 2 of the map is the site's now";

/** The dialog while a map is being saved. */
async function saving() {
  const { nth } = slowServer();
  const [onSaved, onClose] = [vi.fn(), vi.fn()];
  const dialog = { slug: "hall", title: "Save?", action: "Save it", source: "edit", base: MAP, newest: MAP } as const;
  const { leave } = showWithCorner(
    <SaveDialog {...dialog} makeForm={() => new FormData()} onSaved={onSaved} onClose={onClose} />,
  );
  await (await nth(1)).answer(200, NO_CHANGE);
  const save = screen.getByText("Save it").closest("button");
  await waitFor(() => expect(save?.disabled).toBe(false));
  fireEvent.click(screen.getByText("Save it"));
  return { asked: await nth(2), leave, onSaved, onClose };
}

test("what is behind the dialog cannot be drawn on while the map is being saved", async () => {
  const { asked, onSaved, onClose } = await saving();
  fireEvent.keyDown(screen.getByRole("dialog"), { key: "Escape" });
  fireEvent.click(screen.getByText("Keep as it is"));
  expect(onClose).not.toHaveBeenCalled();
  await asked.answer(200, { version: 2 });
  expect(await screen.findByText(SAVED)).toBeTruthy();
  expect(onSaved).toHaveBeenCalledTimes(1);
});

test("a refusal stands in the dialog, which can be closed then", async () => {
  const { asked, onSaved, onClose } = await saving();
  await asked.answer(409);
  expect(await screen.findAllByText("No.")).toHaveLength(1);
  fireEvent.keyDown(screen.getByRole("dialog"), { key: "Escape" });
  expect(onClose).toHaveBeenCalledTimes(1);
  expect(onSaved).not.toHaveBeenCalled();
});

test.each([
  [200, SAVED],
  [409, "No."],
])("who has left the page before the answer is told what came of it: %s", async (status, words) => {
  const { asked, leave, onSaved } = await saving();
  leave();
  await asked.answer(status, { version: 2, code: "refused", detail: "No." });
  expect(await screen.findByText(words)).toBeTruthy();
  expect(onSaved).not.toHaveBeenCalled();
});
