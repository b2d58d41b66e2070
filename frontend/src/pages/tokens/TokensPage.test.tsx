// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { Link } from "react-router-dom";
import { expect, test, vi } from "vitest";
import type { Token } from "@/api/types";
import { keys, makeQueryClient } from "@/api/queries";
import { showAt, showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { AskRevoke, TokensPage } from "./TokensPage";

testsPages();

test("who has closed the question before the end of a token is refused is told", async () => {
  const { nth } = slowServer();
  const token = { id: "1", name: "Display" } as Token;
  const { leave } = showWithCorner(
    <AskRevoke slug="hall" token={token} onClose={() => undefined} afterwards={() => null} />,
  );
  fireEvent.click(screen.getByText("Revoke"));
  const asked = await nth(1);
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});

test("who has revoked a token goes on where it is said what tokens are", async () => {
  vi.stubGlobal("WebSocket", class { close() {} }); // prettier-ignore
  const token = { id: "1", name: "Display", scopes: [], mine: true, last_used_at: null, expires_at: "2026-12-24" };
  const tokens = [token];
  const site = { slug: "hall", name: "Hall", role: "viewer", stop: { active: false } };
  const { nth } = slowServer({ "/tokens": tokens, "/sites/hall": site });
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  showAt("/sites/hall/tokens", [{ path: "/sites/:slug/tokens", element: <TokensPage /> }], queries);
  const row = await screen.findByLabelText("Revoke Display");
  row.focus();
  fireEvent.click(row);
  fireEvent.click(await screen.findByText("Revoke", { selector: "[role=dialog] button *" }));
  const asked = await nth(1);
  tokens.pop();
  await asked.answer(200, {});
  await waitFor(() => expect(document.activeElement?.textContent).toMatch(/^A program shows a token/));
});

test("of two tokens that are made at once each is shown, one after the other", async () => {
  vi.stubGlobal("WebSocket", class { close() {} }); // prettier-ignore
  const { nth, waiting } = slowServer({
    "/tokens": [],
    "/sites/hall": { slug: "hall", name: "Hall", role: "viewer", stop: { active: false } },
  });
  const me = { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } };
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, me);
  showAt("/sites/hall/tokens", [{ path: "/sites/:slug/tokens", element: <TokensPage /> }], queries);
  const form = async (name: string) => {
    fireEvent.click(await screen.findByText("New token"));
    fireEvent.change(await screen.findByLabelText(/^What it is for/), { target: { value: name } });
  };
  for (const name of ["Display", "Robot"]) {
    await form(name);
    fireEvent.click(screen.getByText("Make the token"));
    await nth(name === "Display" ? 1 : 2);
    if (name === "Display") fireEvent.click(screen.getByText("Cancel"));
  }
  await waiting[0]?.answer(200, { id: "1", name: "Display", token: "first-secret" });
  await waiting[1]?.answer(200, { id: "2", name: "Robot", token: "second-secret" });
  expect(await screen.findByDisplayValue("first-secret")).toBeTruthy();
  fireEvent.click(screen.getByText("I have it"));
  expect(await screen.findByDisplayValue("second-secret")).toBeTruthy();
});

test("a token whose page another site's has followed is shown all the same", async () => {
  vi.stubGlobal("WebSocket", class { close() {} }); // prettier-ignore
  const site = (slug: string) => ({ slug, name: slug, role: "viewer", stop: { active: false } });
  const { nth } = slowServer({ "/tokens": [], "/sites/hall": site("hall"), "/sites/yard": site("yard") });
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  const page = (
    <>
      <Link to="/sites/yard/tokens">Another site</Link>
      <TokensPage />
    </>
  );
  showAt("/sites/hall/tokens", [{ path: "/sites/:slug/tokens", element: page }], queries);
  fireEvent.click(await screen.findByText("New token"));
  fireEvent.change(await screen.findByLabelText(/^What it is for/), { target: { value: "Display" } });
  fireEvent.click(screen.getByText("Make the token"));
  const asked = await nth(1);
  fireEvent.click(screen.getByText("Another site"));
  await asked.answer(200, { id: "1", name: "Display", token: "its-secret" });
  expect(await screen.findByDisplayValue("its-secret")).toBeTruthy();
});
