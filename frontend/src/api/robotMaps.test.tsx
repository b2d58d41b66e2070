// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "./queries";
import { mapKeys, useRobotMap } from "./robotMaps";
import { useOldMap } from "./siteMaps";

afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

test("a robot's map that grows while it is fetched is shown with the size of its own cells", async () => {
  let version = 1;
  const answer = (address: string) => {
    const width = version;
    const tag = `"scout-${String(version)}-5"`;
    if (address.endsWith("/cells")) return new Response(new Uint8Array(width), { headers: { ETag: tag } });
    version = 2;
    return new Response(JSON.stringify({ version: width, tag, width, height: 1 }));
  };
  vi.stubGlobal("fetch", (address: string) => Promise.resolve(answer(address)));
  const around = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={makeQueryClient()}>{children}</QueryClientProvider>
  );
  const shown = renderHook(() => useRobotMap("hall", "scout"), { wrapper: around }).result;
  await waitFor(() => expect(shown.current.data).toBeDefined());
  expect([shown.current.data?.width, shown.current.data?.cells.length]).toEqual([2, 2]);
});

test("a map that took the number of a lost one is not shown as that", async () => {
  const answer = (address: string) => {
    const tag = '"hall-2-9"';
    if (address.endsWith("/cells")) return new Response(new Uint8Array(1), { headers: { ETag: tag } });
    return new Response(JSON.stringify({ version: 2, tag, width: 1, height: 1 }));
  };
  vi.stubGlobal("fetch", (address: string) => Promise.resolve(answer(address)));
  const queries = makeQueryClient();
  queries.setQueryData(mapKeys.versions("hall"), []);
  const around = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={queries}>{children}</QueryClientProvider>
  );
  const listed = { version: 2, width: 1, height: 1, resolution_m: 1, source: "upload", by: "Ann", at: "2026-11-20" };
  const look = (tag: string) => renderHook(() => useOldMap("hall", { ...listed, tag }), { wrapper: around }).result;
  const lost = look('"hall-2-5"');
  await waitFor(() => expect(lost.current.error).toMatchObject({ status: 409, code: "map_changed" }));
  expect(queries.getQueryState(mapKeys.versions("hall"))?.isInvalidated).toBe(true);
  const there = look('"hall-2-9"');
  await waitFor(() => expect(there.current.data?.width).toBe(1));
});
