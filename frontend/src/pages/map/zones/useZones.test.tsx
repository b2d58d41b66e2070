// @vitest-environment jsdom
import { act, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import type { SiteMap } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { rectangle } from "./outline";
import { useZones, type ZoneEditing } from "./useZones";

testsPages();

const MAP = { zones: [] } as unknown as SiteMap;

let editing: ZoneEditing;

function Editing() {
  editing = useZones("hall", MAP);
  return null;
}

function drawTo(x: number) {
  act(() => editing.begin());
  act(() => editing.draw({ corners: rectangle([0, 0], [x, x]), closed: true }));
}

test("what comes of a zone that was being added leaves the next one alone, and each refusal is told", async () => {
  const { nth } = slowServer();
  const { leave } = showWithCorner(<Editing />);
  drawTo(1);
  act(() => editing.add({ name: "First" }));
  const first = await nth(1);
  act(() => editing.stop());
  drawTo(2);
  await first.answer(200, { id: "z1" });
  await waitFor(() => expect(editing.isSending).toBe(false));
  expect(editing.drawn?.corners).toEqual(rectangle([0, 0], [2, 2]));
  act(() => editing.add({ name: "Second" }));
  const second = await nth(2);
  leave();
  await second.answer(422);
  expect(await screen.findByText("No.")).toBeTruthy();
});
