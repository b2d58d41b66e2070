// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Device, Site, SiteMap } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { MovableMachine } from "./MovableMachine";

testsPages();

const MAP = { width: 100, height: 100, resolution_m: 0.1, origin: { x: 0, y: 0 } } as unknown as SiteMap;
const SITE = { slug: "hall" } as Site;
const MACHINE = {
  id: "m",
  name: "Mill",
  kind: "machine",
  location: { x: 1, y: 1 },
  methods: [],
  properties: [],
} as unknown as Device;

function move() {
  const machine = screen.getByRole("button");
  for (const key of ["ArrowRight", "Enter"]) fireEvent.keyDown(machine, { key });
}

test("a machine's second move goes out after the first, also where it is not shown any more", async () => {
  const { nth, waiting } = slowServer();
  const { leave } = showWithCorner(
    <svg>
      <MovableMachine site={SITE} map={MAP} device={MACHINE} />
    </svg>,
  );
  move();
  const first = await nth(1);
  move();
  leave();
  await new Promise((done) => setTimeout(done, 50));
  expect(waiting.map(({ sent }) => sent)).toEqual([{ location: { x: 1.1, y: 1 } }]);
  await first.answer(200, {});
  const second = await nth(2);
  expect(second.sent).toEqual({ location: { x: 1.2, y: 1 } });
  await second.answer(409);
  await waitFor(() => expect(screen.getAllByText("No.")).toHaveLength(1));
});
