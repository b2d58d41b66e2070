// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { show, testsPages } from "@/testing/page";
import { AuditPane } from "./AuditPane";

testsPages();

const line = (id: number, actor: string) => ({
  id,
  at: "2026-11-30T08:00:00Z",
  actor,
  actor_kind: "person",
  kind: "stops",
  what: "stop_pressed",
  facts: {},
});

test("older lines that cannot be fetched are said, and asked for again", async () => {
  let isDown = true;
  const next = { headers: { Link: '</api/sites/hall/audit?before=2>; rel="next"' } };
  vi.stubGlobal("fetch", (address: string) => {
    if (!address.endsWith("before=2")) return Promise.resolve(Response.json([line(2, "Ann")], next));
    return Promise.resolve(
      isDown ? Response.json({ detail: "Too much." }, { status: 429 }) : Response.json([line(1, "Bo")]),
    );
  });
  show(<AuditPane slug="hall" />);
  fireEvent.click(await screen.findByText("Show older"));
  expect(await screen.findByText("Too much.")).toBeTruthy();
  expect(screen.getByText("Ann")).toBeTruthy();
  expect(screen.queryByText("Show older")).toBeNull();
  isDown = false;
  fireEvent.click(screen.getByText("Try again"));
  expect(await screen.findByText("Bo")).toBeTruthy();
  expect(screen.queryByText("Too much.")).toBeNull();
});
