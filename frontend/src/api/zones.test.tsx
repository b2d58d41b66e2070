// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { useChangePlace } from "./places";
import { useChangeZone } from "./zones";

afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

/** A server that answers when it is told to. */
function slowServer() {
  const waiting: { body: unknown; answer: () => void }[] = [];
  vi.stubGlobal("fetch", (_: string, asked: RequestInit = {}) => {
    const body: unknown = typeof asked.body === "string" ? JSON.parse(asked.body) : null;
    return new Promise((done) => waiting.push({ body, answer: () => done(new Response("{}", { status: 200 })) }));
  });
  return waiting;
}

const around = ({ children }: { children: ReactNode }) => (
  <QueryClientProvider client={new QueryClient()}>{children}</QueryClientProvider>
);

test("what is changed of a zone twice in a moment goes out one after the other", async () => {
  const waiting = slowServer();
  const { result } = renderHook(() => useChangeZone("hall"), { wrapper: around });
  result.current.mutate({ do: "edit", id: "door", fields: { rule: "one_at_a_time", robots: 3 } });
  result.current.mutate({ do: "edit", id: "door", fields: { rule: "slow", speed_m_s: 0.3 } });
  await waitFor(() => expect(waiting).toHaveLength(1));
  await new Promise((done) => setTimeout(done, 50));
  expect(waiting.map(({ body }) => body)).toEqual([{ rule: "one_at_a_time", robots: 3 }]);
  waiting[0]?.answer();
  await waitFor(() => expect(waiting).toHaveLength(2));
  expect(waiting[1]?.body).toEqual({ rule: "slow", speed_m_s: 0.3 });
});

test("so do changes of places", async () => {
  const waiting = slowServer();
  const { result } = renderHook(() => useChangePlace("hall"), { wrapper: around });
  result.current.mutate({ do: "edit", id: "dock", fields: { name: "Dock" } });
  result.current.mutate({ do: "edit", id: "dock", fields: { name: "Dock 1" } });
  await waitFor(() => expect(waiting).toHaveLength(1));
  await new Promise((done) => setTimeout(done, 50));
  expect(waiting).toHaveLength(1);
  waiting[0]?.answer();
  await waitFor(() => expect(waiting).toHaveLength(2));
});
