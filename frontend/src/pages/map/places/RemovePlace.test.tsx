// @vitest-environment jsdom
import { act, fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { MapPlace, Program } from "@/api/types";
import { show, showWithCorner, testsPages } from "@/testing/page";
import { FINISHED, run, serveRuns } from "@/testing/runs";
import { slowServer } from "@/testing/slowServer";
import { PlaceUses, RemovePlace } from "./RemovePlace";

testsPages();

const PROGRAM = { id: "p-5", name: "Nightly", places: ["dock"], devices: [] } as unknown as Program;

test("who removes a place is told of a run that goes there since before the newest fifty", async () => {
  serveRuns([...FINISHED, run(5, { status: "running" })], [PROGRAM]);
  show(<PlaceUses slug="a" place="dock" />);
  const link = await screen.findByRole("link", { name: /5/ });
  expect(link.getAttribute("href")).toBe("/runs/run-5");
});

test("who has closed the question before a removal is refused is told", async () => {
  const { nth } = slowServer();
  const place = { id: "dock", name: "Dock" } as MapPlace;
  const { leave } = showWithCorner(
    <RemovePlace slug="hall" place={place} select={() => undefined} onClose={() => undefined} />,
  );
  fireEvent.click(screen.getByText("Remove the place"));
  leave();
  await (await nth(1)).answer(409);
  expect(await screen.findByRole("alert")).toBeTruthy();
});

test("who still sees the question is told there alone, and nobody that somebody else has removed it", async () => {
  const { nth } = slowServer();
  const place = { id: "dock", name: "Dock" } as MapPlace;
  const { leave } = showWithCorner(
    <RemovePlace slug="hall" place={place} select={() => undefined} onClose={() => undefined} />,
  );
  fireEvent.click(screen.getByText("Remove the place"));
  await (await nth(1)).answer(409);
  expect((await screen.findAllByRole("alert")).map(({ textContent }) => textContent)).toEqual(["No."]);
  fireEvent.click(screen.getByText("Remove the place"));
  const second = await nth(2);
  leave();
  await second.answer(404, { code: "no_such_place", detail: "There is no such place." });
  await act(() => new Promise((done) => setTimeout(done, 50)));
  expect(screen.queryAllByRole("alert")).toEqual([]);
});
