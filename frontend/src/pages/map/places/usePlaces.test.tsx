// @vitest-environment jsdom
import { act, fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import type { SiteMap } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { PlacesPanel } from "./PlacesPanel";
import { usePlaces, type PlaceEditing } from "./usePlaces";

testsPages();

const MAP = { places: [{ id: "p1", name: "Dock A", kind: "dock", x: 1, y: 1, theta: 0 }] } as unknown as SiteMap;

let editing: PlaceEditing;

function Panel() {
  editing = usePlaces("hall", MAP);
  return <PlacesPanel slug="hall" map={MAP} editing={editing} />;
}

function addAt(x: number) {
  act(() => editing.begin());
  act(() => editing.put([x, 2]));
}

test("what comes of a place that was being added leaves the next one that is being added alone", async () => {
  const { nth } = slowServer();
  showWithCorner(<Panel />);
  addAt(2);
  act(() => editing.add("Dock B", "dock"));
  const first = await nth(1);
  act(() => editing.stop());
  addAt(3);
  await first.answer(200, { id: "p2" });
  await waitFor(() => expect(editing.isSending).toBe(false));
  expect(editing.adding).toEqual({ at: [3, 2] });
  act(() => editing.add("Dock C", "dock"));
  await (await nth(2)).answer(200, { id: "p1" });
  await waitFor(() => expect(editing.adding).toBeNull());
  expect(editing.place?.id).toBe("p1");
});

test("a place that is refused after its adding was stopped is told", async () => {
  const { nth } = slowServer();
  const { leave } = showWithCorner(<Panel />);
  addAt(2);
  fireEvent.change(screen.getByLabelText("Name"), { target: { value: "Dock A" } });
  fireEvent.submit(screen.getByRole("form"));
  const asked = await nth(1);
  expect(asked.sent).toEqual({ name: "Dock A", kind: "point", x: 2, y: 2 });
  leave();
  await asked.answer(409);
  expect(await screen.findByRole("alert")).toBeTruthy();
});
