// @vitest-environment jsdom
import { cleanup, fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Device, Site } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { DeviceDetail } from "./DeviceDetail";

testsPages();

const ADMIN = { slug: "hall", role: "admin" } as Site;
const MILL = {
  id: "mill",
  name: "Mill",
  kind: "machine",
  lifecycle: "approved",
  status: "idle",
  doing: "",
  activity: null,
  has_key: true,
  is_placed: true,
  location: { x: 1, y: 1, z: 0, theta: 0 },
  methods: [],
  asks: [],
  properties: [],
} as unknown as Device;

async function openMenu(device: Device) {
  showWithCorner(<DeviceDetail site={ADMIN} device={device} />);
  fireEvent.click(screen.getByLabelText("More"));
  await screen.findByText("Rename");
}

test("a machine that people placed goes back to where it says itself", async () => {
  const { nth } = slowServer();
  await openMenu(MILL);
  fireEvent.click(screen.getByText("Use its own place"));
  const asked = await nth(1);
  expect([asked.asked, asked.sent]).toEqual(["PATCH /devices/mill", { location: null }]);
  await asked.answer(200, {});
  expect(await screen.findByText("Mill stands where it says itself.")).toBeTruthy();
});

test("what stands where it says itself, and a robot, is offered no way back to there", async () => {
  slowServer();
  for (const device of [
    { ...MILL, is_placed: false },
    { ...MILL, kind: "robot" as const },
  ]) {
    await openMenu(device);
    expect(screen.queryByText("Use its own place")).toBeNull();
    cleanup();
  }
});
