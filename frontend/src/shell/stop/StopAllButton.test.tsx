// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import { startI18n } from "@/i18n";
import { EMPTY, useLiveStore } from "@/live/store";
import { StopAllButton } from "./StopAllButton";

const SITE = { slug: "hall", name: "Hall", stop: { active: true, by: "Bo", at: "" } };
let sent: string[];

beforeEach(async () => {
  sent = [];
  vi.stubGlobal("matchMedia", () => ({ matches: false, addEventListener() {}, removeEventListener() {} }));
  vi.stubGlobal("fetch", (path: string, { method }: RequestInit) => {
    if (method === "POST") sent.push(path);
    return Promise.resolve(Response.json(path === "/api/sites/hall" ? SITE : []));
  });
  await startI18n();
});
afterEach(() => {
  cleanup();
  useLiveStore.setState(EMPTY);
});

test.each([
  ["live", []],
  ["reconnecting", ["/api/sites/hall/stop"]],
  ["refused", ["/api/sites/hall/stop"]],
] as const)("whether a stopped site is stopped once more while its line is %s", async (connection, wanted) => {
  useLiveStore.setState({ ...EMPTY, site: "hall", connection });
  const queries = makeQueryClient();
  queries.setQueryData(keys.site("hall"), SITE);
  render(
    <QueryClientProvider client={queries}>
      <MantineProvider env="test">
        <StopAllButton slug="hall" />
      </MantineProvider>
    </QueryClientProvider>,
  );
  fireEvent.click(screen.getByText("Stopped"));
  await act(() => new Promise<void>((done) => setTimeout(done)));
  expect(sent).toEqual(wanted);
});
