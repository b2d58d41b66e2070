// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import { showAt, testsPages } from "@/testing/page";
import { LibraryPage } from "./LibraryPage";

testsPages();
beforeEach(() => vi.stubGlobal("WebSocket", class { close() {} })); // prettier-ignore

/** The page at the address of a function that the server answers for so. */
function open(status: number) {
  vi.stubGlobal("fetch", (address: string) =>
    Promise.resolve(address.includes("/library/f?") ? Response.json({ detail: "No." }, { status }) : Response.json([])),
  );
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.site("hall"), { slug: "hall", name: "Hall", role: "viewer", stop: { active: false } });
  showAt("/sites/hall/library/f", [{ path: "/sites/:slug/library/:id?", element: <LibraryPage /> }], queries);
}

test("the address of a function that is gone says so and leads to the list", async () => {
  open(404);
  const told = await screen.findByText(/^There is no such function, or not any more/);
  expect(told.getAttribute("role")).toBe("alert");
  fireEvent.click(screen.getByText("Back to the list"));
  expect(await screen.findByText("The library is empty")).toBeTruthy();
  expect(screen.queryByText(/^There is no such function/)).toBeNull();
});

test("one that cannot be fetched can be asked for again", async () => {
  open(429);
  expect(await screen.findByText("No.")).toBeTruthy();
  open(404);
  fireEvent.click(screen.getByText("Try again"));
  expect(await screen.findByText(/^There is no such function/)).toBeTruthy();
});
