// @vitest-environment jsdom
/** A row of a list is taken by a whole press: a finger that begins on it may scroll the list. */
import { cleanup, fireEvent, screen } from "@testing-library/react";
import type { ReactElement } from "react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { EMPTY_DOCUMENT } from "@/program/document/document";
import { surroundingsOf } from "@/program/surroundings";
import { show, testsPages } from "@/testing/page";
import { DevicePalette } from "../canvas/DevicePalette";
import { SuggestionList } from "../inspector/expression/SuggestionList";
import { type OpenProgram, ProgramContext } from "../state/context";
import { RESTING, takeTool } from "../state/tool";
import { resetUi, useUi } from "../state/ui";
import { MoreTools } from "./MoreTools";
import { QuickAdd } from "./QuickAdd";

const DEVICE = { id: "oven", name: "Oven", kind: "machine", device_class: "oven", methods: [], gives: [], takes: [] };
const open = {
  t: (key: string) => key,
  document: EMPTY_DOCUMENT,
  devices: [DEVICE],
  plan: null,
  canEdit: true,
  surroundings: surroundingsOf([], []),
} as unknown as OpenProgram;

testsPages();
beforeEach(resetUi);
afterEach(cleanup);

const chosen = vi.fn();
const suggestion = { kind: "device", label: "oven" } as never;
test.each<{ name: string; prepare?: () => void; list: ReactElement; row: string; isTaken: () => boolean }>([
  {
    name: "all constructs",
    prepare: () => useUi.setState({ more: true }),
    list: <MoreTools />,
    row: "kind.notify",
    isTaken: () => useUi.getState().gesture.tool === "notify",
  },
  {
    name: "the short list on the map",
    prepare: () => useUi.setState({ quick: { x: 5, y: 5, at: [1, -1], device: null } }),
    list: <QuickAdd />,
    row: "Pick-and-Drop",
    isTaken: () => useUi.getState().quick === null,
  },
  {
    name: "devices",
    prepare: () => useUi.setState({ gesture: takeTool(RESTING, "move", true) }),
    list: <DevicePalette onChoose={chosen} />,
    row: "Oven",
    isTaken: () => chosen.mock.calls.length > 0,
  },
  {
    name: "what an expression may say",
    list: <SuggestionList id="s" label="list" suggestions={[suggestion]} marked={0} choose={chosen} />,
    row: "oven",
    isTaken: () => chosen.mock.calls.length > 0,
  },
])("a row of $name", ({ prepare, list, row, isTaken }) => {
  chosen.mockClear();
  prepare?.();
  show(<ProgramContext value={open}>{list}</ProgramContext>);
  const found = screen.getByText(row);
  expect(fireEvent.pointerDown(found, { pointerType: "touch" }), "the field keeps the keyboard").toBe(false);
  fireEvent.pointerCancel(found, { pointerType: "touch" });
  expect(isTaken()).toBe(false);
  fireEvent.click(screen.getByText(row));
  expect(isTaken()).toBe(true);
});
