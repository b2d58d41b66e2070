// @vitest-environment jsdom
import { QueryClient } from "@tanstack/react-query";
import { act, screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, test, vi } from "vitest";
import { keys } from "@/api/queries";
import type { Alert } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { DeviceAlerts } from "./DeviceAlerts";

const AT = "2026-11-21T12:00:00+00:00";
const ALERT: Alert = {
  ...{ id: 7, device: "mixer", code: "error", severity: "error", role: "viewer", args: {}, text: "", count: 1 },
  ...{ state: "open", first_at: AT, last_at: AT, over_at: null, seen_by: "", seen_at: null },
};

testsPages();
beforeEach(() => {
  vi.stubGlobal("fetch", () => Promise.resolve(Response.json({ ...ALERT, state: "seen" })));
});

test("whoever has seen the last alert over a run is not thrown back to the page's beginning", async () => {
  const queries = new QueryClient({ defaultOptions: { queries: { staleTime: Infinity } } });
  queries.setQueryData(keys.site("works"), { slug: "works", role: "operator" });
  queries.setQueryData(keys.devices("works"), []);
  queries.setQueryData(keys.alerts("works"), [ALERT]);
  show(<DeviceAlerts slug="works" devices={["mixer"]} brief />, queries);
  const seen = screen.getByRole("button");
  seen.focus();
  act(() => seen.click());
  await waitFor(() => expect(screen.queryByRole("button")).toBeNull(), { timeout: 20_000 });
  expect(document.activeElement).not.toBe(document.body);
});
