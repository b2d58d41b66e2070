// @vitest-environment jsdom
import { screen } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import type { Device, Site } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { LiveProperties } from "./LiveProperties";

testsPages();

test("a small reading is shown with its figures, and none is a zero with a sign", () => {
  vi.stubGlobal("fetch", () => Promise.resolve(Response.json({ points: [], bucket_s: 0 })));
  const reading = (name: string, value: number, unit: string) => ({ name, title: name, type: "number", unit, value });
  const properties = [reading("pressure", 0.04, "BAR"), reading("load", -0.0004, "KiloGM"), reading("zero", -0, "")];
  const device = { id: "tank", status: "idle", last_seen_at: null, properties } as unknown as Device;
  show(<LiveProperties site={{ slug: "hall" } as Site} device={device} />);
  const told = screen.getAllByRole("listitem").map((item) => item.querySelector("span")?.firstChild?.textContent);
  expect(told).toEqual(["0.04", "-0.0004", "0"]);
});
