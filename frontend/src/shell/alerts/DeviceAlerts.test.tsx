// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, render, screen, waitFor } from "@testing-library/react";
import { MemoryRouter } from "react-router-dom";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys } from "@/api/queries";
import type { Alert } from "@/api/types";
import { startI18n } from "@/i18n";
import { DeviceAlerts } from "./DeviceAlerts";

const AT = "2026-11-21T12:00:00+00:00";
const ALERT: Alert = {
  ...{ id: 7, device: "mixer", code: "error", severity: "error", role: "viewer", args: {}, text: "", count: 1 },
  ...{ state: "open", first_at: AT, last_at: AT, over_at: null, seen_by: "", seen_at: null },
};

beforeEach(async () => {
  const media = { matches: false, addEventListener: () => undefined, removeEventListener: () => undefined };
  vi.stubGlobal("matchMedia", () => media);
  vi.stubGlobal("fetch", () => Promise.resolve(Response.json({ ...ALERT, state: "seen" })));
  await startI18n();
});
afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

test("whoever has seen the last alert over a run is not thrown back to the page's beginning", async () => {
  const queries = new QueryClient({ defaultOptions: { queries: { staleTime: Infinity } } });
  queries.setQueryData(keys.site("works"), { slug: "works", role: "operator" });
  queries.setQueryData(keys.devices("works"), []);
  queries.setQueryData(keys.alerts("works"), [ALERT]);
  render(
    <MantineProvider>
      <QueryClientProvider client={queries}>
        <MemoryRouter>
          <DeviceAlerts slug="works" devices={["mixer"]} brief />
        </MemoryRouter>
      </QueryClientProvider>
    </MantineProvider>,
  );
  const seen = screen.getByRole("button");
  seen.focus();
  act(() => seen.click());
  await waitFor(() => expect(screen.queryByRole("button")).toBeNull(), { timeout: 20_000 });
  expect(document.activeElement).not.toBe(document.body);
});
