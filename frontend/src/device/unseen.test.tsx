// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Device, DeviceMethod, Site } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { TryMethod } from "./methods/TryMethod";
import { MeasuredTimes } from "./paces/MeasuredTimes";
import { StandInCard } from "./standIn/StandInCard";

testsPages();

const SITE = { slug: "hall", role: "admin" } as Site;
const DEVICE = {
  id: "m",
  name: "Mill",
  lifecycle: "approved",
  stand_in: true,
  gives: [],
  takes: [],
} as unknown as Device;
const METHOD = { name: "grind", parameters: [] } as unknown as DeviceMethod;
const OF_DEVICE = { site: SITE, device: DEVICE };
const PACE = { method: "grind", newest: [], band: null, usual: null, change: null, calibrated: null, count: 3 };

test.each([
  ["what was started by hand", "Start", () => <TryMethod {...OF_DEVICE} method={METHOD} onClose={() => undefined} />],
  ["the end of a stand-in", "Use the real one again", () => <StandInCard {...OF_DEVICE} />],
  ["a measured time for rehearsals", "Use in rehearsals", () => <MeasuredTimes {...OF_DEVICE} />],
])("%s is told who has left the device before it is refused", async (_, go, part) => {
  const { nth } = slowServer({ "/paces": [{ ...PACE, can_be_taken: true }] });
  const { leave } = showWithCorner(part());
  fireEvent.click(await screen.findByText(go));
  const asked = await nth(1);
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});

const CALL = {
  id: "c",
  status: "running",
  over: false,
  created_at: "2026-11-30T08:00:00Z",
  ended_at: null,
  result: {},
};

test("what was started by hand and could not be cancelled is told who has left it", async () => {
  const { nth } = slowServer({ "/calls/c": CALL });
  const { leave } = showWithCorner(<TryMethod {...OF_DEVICE} method={METHOD} onClose={() => undefined} />);
  fireEvent.click(screen.getByText("Start"));
  await (await nth(1)).answer(200, CALL);
  fireEvent.click(await screen.findByText("Cancel it"));
  const asked = await nth(2);
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});
