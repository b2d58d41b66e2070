// @vitest-environment jsdom
import { screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Program } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { FINISHED, run, serveRuns } from "@/testing/runs";
import { PlaceUses } from "./RemovePlace";

testsPages();

const PROGRAM = { id: "p-5", name: "Nightly", places: ["dock"], devices: [] } as unknown as Program;

test("who removes a place is told of a run that goes there since before the newest fifty", async () => {
  serveRuns([...FINISHED, run(5, { status: "running" })], [PROGRAM]);
  show(<PlaceUses slug="a" place="dock" />);
  const link = await screen.findByRole("link", { name: /5/ });
  expect(link.getAttribute("href")).toBe("/runs/run-5");
});
