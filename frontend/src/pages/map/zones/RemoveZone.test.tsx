// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { MapZone, Program, SiteMap } from "@/api/types";
import { show, showWithCorner, testsPages } from "@/testing/page";
import { FINISHED, run, serveRuns } from "@/testing/runs";
import { slowServer } from "@/testing/slowServer";
import { RemoveZone, ZoneUses } from "./RemoveZone";

testsPages();

const PROGRAM = { id: "p-5", name: "Nightly", places: ["dock"], devices: [] } as unknown as Program;
const MAP = { places: [{ id: "dock", name: "Dock", kind: "spot", x: 1, y: 1 }] } as unknown as SiteMap;
const ZONE = {
  id: "z",
  points: [
    [0, 0],
    [2, 0],
    [2, 2],
    [0, 2],
  ],
} as unknown as MapZone;

test("who removes a zone is told of a run that goes there since before the newest fifty", async () => {
  serveRuns([...FINISHED, run(5, { status: "running" })], [PROGRAM]);
  show(<ZoneUses slug="a" map={MAP} zone={ZONE} />);
  const link = await screen.findByRole("link", { name: /5/ });
  expect(link.getAttribute("href")).toBe("/runs/run-5");
});

test("who has closed the question before a removal is refused is told", async () => {
  const { nth } = slowServer();
  const { leave } = showWithCorner(
    <RemoveZone slug="hall" map={MAP} zone={ZONE} select={() => undefined} onClose={() => undefined} />,
  );
  fireEvent.click(screen.getByText("Remove the zone"));
  leave();
  await (await nth(1)).answer(409);
  expect(await screen.findByRole("alert")).toBeTruthy();
});
