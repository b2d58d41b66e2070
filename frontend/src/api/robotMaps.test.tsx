// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "./queries";
import { useRobotMap } from "./robotMaps";

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
