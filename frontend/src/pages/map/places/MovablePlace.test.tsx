// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { MapPlace, SiteMap } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { MovablePlace } from "./MovablePlace";

testsPages();

const MAP = { width: 100, height: 100, resolution_m: 0.1, origin: { x: 0, y: 0 } } as unknown as SiteMap;
const PLACE = { id: "p1", name: "Dock", kind: "point", x: 1, y: 1, theta: 0 } as MapPlace;

test("each move of a place that is refused is told who has left the places", async () => {
  const { nth } = slowServer();
  const { leave } = showWithCorner(
    <svg>
      <MovablePlace slug="hall" map={MAP} place={PLACE} isSelected onSelect={() => undefined} />
    </svg>,
  );
  const place = screen.getByRole("button");
  for (const key of ["ArrowRight", "Enter", "ArrowRight", "Enter"]) fireEvent.keyDown(place, { key });
  const first = await nth(1);
  leave();
  await first.answer(409, { code: "refused", detail: "The first one." });
  expect(await screen.findByText("The first one.")).toBeTruthy();
  const second = await nth(2);
  expect([first.sent, second.sent]).toEqual([
    { x: 1.1, y: 1 },
    { x: 1.2, y: 1 },
  ]);
  await second.answer(409, { code: "refused", detail: "The second one." });
  expect(await screen.findByText("The second one.")).toBeTruthy();
});
