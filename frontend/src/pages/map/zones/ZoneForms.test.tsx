// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import type { MapZone, SiteMap } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { ZoneForm } from "./ZoneForms";

testsPages();

const MAP = { places: [] } as unknown as SiteMap;
const ZONE = {
  ...{ id: "z", name: "Aisle", rule: "one_way", speed_m_s: null, robots: null, heading_deg: 90 },
  points: [
    [0, 0],
    [2, 0],
    [0, 2],
  ],
} as unknown as MapZone;

function begun(more: Partial<MapZone> = {}) {
  const server = slowServer();
  const form = <ZoneForm slug="hall" map={MAP} zone={{ ...ZONE, ...more }} remove={() => undefined} />;
  return { ...server, ...showWithCorner(form) };
}

function change(field: HTMLElement, value: string) {
  fireEvent.change(field, { target: { value } });
  fireEvent.blur(field);
}

test("each change of a zone that is refused is told and taken back, also where another has followed", async () => {
  const { nth } = begun();
  const [name, heading] = [
    screen.getByLabelText<HTMLInputElement>("Name"),
    screen.getByLabelText<HTMLSelectElement>("Where robots drive"),
  ];
  change(name, "Way");
  change(heading, "180");
  await (await nth(1)).answer(409, { code: "refused", detail: "The first one." });
  expect((await screen.findByRole("alert")).textContent).toContain("The first one.");
  await waitFor(() => expect(name.value).toBe("Aisle"));
  expect(heading.value).toBe("180");
  const second = await nth(2);
  expect(second.sent).toEqual({ rule: "one_way", heading_deg: 180 });
  await second.answer(409, { code: "refused", detail: "The second one." });
  await waitFor(() => expect(heading.value).toBe("90"));
  expect(screen.getAllByRole("alert")).toHaveLength(2);
});

test("a speed that is refused is taken back, and told who has left the zones", async () => {
  const { nth, leave } = begun({ rule: "slow", speed_m_s: 0.3 });
  const speed = () => screen.getByLabelText<HTMLInputElement>("At most");
  change(speed(), "0.5 m/s");
  await (await nth(1)).answer(422);
  await waitFor(() => expect(speed().value).toBe("0.3 m/s"));
  change(speed(), "0.7 m/s");
  const second = await nth(2);
  leave();
  await second.answer(422);
  await waitFor(() => expect(screen.getAllByRole("alert")).toHaveLength(2));
});
