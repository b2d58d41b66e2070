// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import type { MapPlace } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { PlaceForm } from "./PlaceForm";

testsPages();

const PLACE = { id: "p1", name: "Dock A", kind: "dock", x: 1, y: 1, theta: 0 } as MapPlace;
const TAKEN = { code: "place_taken", detail: "There is already a place Dock B." };

function begun() {
  const server = slowServer();
  return { ...server, ...showWithCorner(<PlaceForm slug="hall" place={PLACE} remove={() => undefined} />) };
}

const nameField = () => screen.getByLabelText<HTMLInputElement>("Name");
const write = (name: string) => fireEvent.change(nameField(), { target: { value: name } });

function rename(name: string) {
  write(name);
  fireEvent.blur(nameField());
}

test("a name that is refused is told and taken back, also where the kind was changed after it", async () => {
  const { nth } = begun();
  rename("Dock B");
  fireEvent.click(screen.getByDisplayValue("room"));
  await (await nth(1)).answer(409, TAKEN);
  expect((await screen.findByRole("alert")).textContent).toContain(TAKEN.detail);
  await waitFor(() => expect(nameField().value).toBe("Dock A"));
  const second = await nth(2);
  expect(second.sent).toEqual({ kind: "room" });
  await second.answer(200, {});
});

test("a name that is refused after the places are left is told", async () => {
  const { nth, leave } = begun();
  rename("Dock B");
  leave();
  await (await nth(1)).answer(409, TAKEN);
  expect((await screen.findByRole("alert")).textContent).toContain(TAKEN.detail);
});

test("what is typed when a name is refused stays", async () => {
  const { nth } = begun();
  rename("Dock B");
  const first = await nth(1);
  write("Dock C");
  await first.answer(409, TAKEN);
  await screen.findByRole("alert");
  expect(nameField().value).toBe("Dock C");
  fireEvent.blur(nameField());
  expect((await nth(2)).sent).toEqual({ name: "Dock C" });
});

test("a name that is kept by Enter is sent once, and Esc goes back to it", async () => {
  const { nth, waiting } = begun();
  write("Dock B");
  fireEvent.keyDown(nameField(), { key: "Enter" });
  write("Dock");
  fireEvent.keyDown(nameField(), { key: "Escape" });
  expect(nameField().value).toBe("Dock B");
  fireEvent.blur(nameField());
  await (await nth(1)).answer(409, TAKEN);
  await waitFor(() => expect(nameField().value).toBe("Dock A"));
  expect(waiting).toHaveLength(1);
  rename("Dock B");
  await nth(2);
});

test("a heading that is refused is taken back", async () => {
  const { nth } = begun();
  const heading = () => screen.getByLabelText<HTMLInputElement>("Robots stand facing");
  fireEvent.change(heading(), { target: { value: "90°" } });
  fireEvent.blur(heading());
  const asked = await nth(1);
  expect(asked.sent).toEqual({ theta: Math.PI / 2 });
  await asked.answer(403);
  await waitFor(() => expect(heading().value).toBe("0°"));
});
