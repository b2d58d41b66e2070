// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import type { Device, RobotMap, Site } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { UseRobotMap } from "./UseRobotMap";

testsPages();

const SITE = { slug: "hall", name: "Hall", has_map: false } as Site;
const SCOUT = { id: "scout", name: "Scout" } as Device;
const PLAN = { width: 2, height: 2, resolution_m: 1, origin: { x: 0, y: 0 } };
const TAG = '"scout-3-5"';
const MAP = { ...PLAN, version: 3, tag: TAG, cells: new Uint8Array(4) } as unknown as RobotMap;

test("who has closed the question before a robot's map is refused is told", async () => {
  const { nth } = slowServer({ "/map/difference": { version: 3, tag: TAG, replaces: 1, troubles: [] } });
  vi.stubGlobal(
    "Path2D",
    class {
      rect() {}
    },
  ); // jsdom draws nothing
  const { leave } = showWithCorner(<UseRobotMap site={SITE} device={SCOUT} map={MAP} onClose={() => undefined} />);
  const go = screen.getByText("Use this map");
  await waitFor(() => expect(go.closest("button")?.disabled).toBe(false));
  fireEvent.click(go);
  const asked = await nth(1);
  leave();
  await asked.answer(412);
  expect(await screen.findByText("No.")).toBeTruthy();
});
