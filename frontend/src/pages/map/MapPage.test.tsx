// @vitest-environment jsdom
import { screen } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import type { Role } from "@/api/types";
import { keys, makeQueryClient } from "@/api/queries";
import { showAt, testsPages } from "@/testing/page";
import { MapPage } from "./MapPage";

testsPages();

/** A server that knows nothing else, and what jsdom has no canvas for. */
function stub() {
  vi.stubGlobal(
    "WebSocket",
    class {
      close() {}
    },
  );
  vi.stubGlobal(
    "Path2D",
    class {
      rect() {}
    },
  );
  vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);
  vi.stubGlobal("fetch", () => Promise.resolve(Response.json([])));
}

const MAP = {
  version: 1,
  width: 4,
  height: 4,
  resolution_m: 0.5,
  origin: { x: 0, y: 0, theta: 0 },
  cells: new Uint8Array(16),
  places: [{ id: "gate", name: "Gate", kind: "point", x: 1, y: 1, theta: null, size: null, aliases: [] }],
  zones: [],
  obstacles: [],
};

/** The address that asks for the places, as somebody of that role sees it. */
function openPlaces(role: Role) {
  stub();
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role, has_map: true, stop: { active: false } });
  queries.setQueryData(keys.map("hall"), MAP);
  queries.setQueryData(keys.devices("hall"), []);
  showAt("/sites/hall/map?places", [{ path: "/sites/:slug/map", element: <MapPage /> }], queries);
}

const buttons = (name: string) => screen.queryAllByRole("button", { name }).length;

test("who may change places changes them at once where the address asks for that", async () => {
  openPlaces("admin");
  expect(await screen.findByRole("heading", { name: "Places" })).toBeTruthy();
  expect([buttons("Finish places"), buttons("Add a place")]).toEqual([1, 1]);
});

test("who only looks gets no handles and forms by an address that asks for them", async () => {
  openPlaces("viewer");
  expect(await screen.findByRole("heading", { name: "Places" })).toBeTruthy();
  expect([buttons("Finish places"), buttons("Add a place")]).toEqual([0, 0]);
});
