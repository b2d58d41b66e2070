// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { MapZone } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { ReleasedZone } from "./ReleasedZone";

testsPages();

const AT = Date.parse("2026-11-30T08:00:00Z");
const ZONE = {
  id: "z",
  name: "Aisle",
  rule: "release",
  points: [],
  open_until: "2026-11-30T09:00:00Z",
} as unknown as MapZone;

test.each([
  ["that it opens for longer", ["Another time …", "For 15 minutes"]],
  ["that it shuts", ["Close now"]],
])("who has left a zone is told when it is refused %s", async (_, presses) => {
  const { nth } = slowServer({ "/sites/hall": { slug: "hall", role: "admin" } });
  const { leave } = showWithCorner(<ReleasedZone slug="hall" zone={ZONE} at={AT} />);
  for (const press of presses) fireEvent.click(await screen.findByText(press));
  const asked = await nth(1);
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});
