// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { cleanup, renderHook } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { slowServer } from "@/testing/slowServer";
import { useChangePlace } from "./places";
import { useChangeZone } from "./zones";

afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

const around = ({ children }: { children: ReactNode }) => (
  <QueryClientProvider client={new QueryClient()}>{children}</QueryClientProvider>
);

test("what is changed of a zone twice in a moment goes out one after the other", async () => {
  const { nth, waiting } = slowServer();
  const { result } = renderHook(() => useChangeZone("hall", () => undefined), { wrapper: around });
  result.current.mutate({ do: "edit", id: "door", fields: { rule: "one_at_a_time", robots: 3 } });
  result.current.mutate({ do: "edit", id: "door", fields: { rule: "slow", speed_m_s: 0.3 } });
  await nth(1);
  await new Promise((done) => setTimeout(done, 50));
  expect(waiting.map(({ sent }) => sent)).toEqual([{ rule: "one_at_a_time", robots: 3 }]);
  await waiting[0]?.answer(200);
  await nth(2);
  expect(waiting[1]?.sent).toEqual({ rule: "slow", speed_m_s: 0.3 });
});

test("so do changes of places", async () => {
  const { nth, waiting } = slowServer();
  const { result } = renderHook(() => useChangePlace("hall", () => undefined), { wrapper: around });
  result.current.mutate({ do: "edit", id: "dock", fields: { name: "Dock" } });
  result.current.mutate({ do: "edit", id: "dock", fields: { name: "Dock 1" } });
  await nth(1);
  await new Promise((done) => setTimeout(done, 50));
  expect(waiting).toHaveLength(1);
  await waiting[0]?.answer(200);
  await nth(2);
});
