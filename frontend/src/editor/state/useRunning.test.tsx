// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import type { Program, Site } from "@/api/types";
import { useRunning } from "./useRunning";
import { useScreen } from "./screen";

afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

test("the steps of a run that goes on since before the newest fifty are lit", async () => {
  const run = (number: number, status: string) => ({
    id: `run-${number}`,
    number,
    program: { id: "p", name: "Nightly" },
    status,
    steps: { [`step-${number}`]: { status } },
  });
  const newest = Array.from({ length: 50 }, (_, index) => run(60 - index, "finished"));
  vi.stubGlobal("fetch", (path: string) => {
    const runs = path.includes("state=open") ? [run(5, "running")] : newest;
    return Promise.resolve(new Response(JSON.stringify(runs), { status: 200 }));
  });
  const queries = makeQueryClient();
  const wrapper = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={queries}>{children}</QueryClientProvider>
  );
  renderHook(() => useRunning({ site: { slug: "a" } as Site, program: { id: "p" } as Program }), { wrapper });
  await waitFor(() => expect(useScreen.getState().running).toEqual(["step-5"]));
});
