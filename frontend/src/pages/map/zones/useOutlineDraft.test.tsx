// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, renderHook, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import type { MapZone } from "@/api/types";
import type { Outline } from "./outline";
import { useOutlineDraft } from "./useOutlineDraft";

afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

const triangle = (x: number): Outline => [
  [0, 0],
  [x, 0],
  [0, 1],
];
const zoneOf = (points: Outline) => ({ id: "aisle", points }) as unknown as MapZone;

/** A server that answers when it is told to, and a zone that is drawn with its present outline. */
function begun() {
  const waiting: { sent: unknown; answer: (status: number) => void }[] = [];
  vi.stubGlobal("fetch", (_: string, asked: RequestInit = {}) => {
    const { points } = JSON.parse(asked.body as string) as { points: unknown };
    return new Promise((done) =>
      waiting.push({ sent: points, answer: (status) => done(new Response("{}", { status })) }),
    );
  });
  const queries = makeQueryClient();
  const wrapper = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={queries}>{children}</QueryClientProvider>
  );
  const hook = renderHook(({ zone }) => useOutlineDraft("hall", zone), {
    wrapper,
    initialProps: { zone: zoneOf(triangle(1)) },
  });
  const sent = (count: number) => waitFor(() => expect(waiting).toHaveLength(count));
  return { waiting, hook, sent };
}

test("what is dragged when the answer to the change before comes stays in hand", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.show(triangle(3)));
  await act(() => Promise.resolve(waiting[0]?.answer(200)));
  hook.rerender({ zone: zoneOf(triangle(2)) });
  expect(hook.result.current.points).toEqual(triangle(3));
  act(() => hook.result.current.keep());
  await sent(2);
  expect(waiting[1]?.sent).toEqual(triangle(3));
});

test("a second change waits for the first and is sent then", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.keep(triangle(3)));
  hook.rerender({ zone: zoneOf(triangle(2)) });
  expect(hook.result.current.points).toEqual(triangle(3));
  await act(() => Promise.resolve(waiting[0]?.answer(200)));
  await sent(2);
  expect(waiting[1]?.sent).toEqual(triangle(3));
  await act(() => Promise.resolve(waiting[1]?.answer(200)));
  hook.rerender({ zone: zoneOf(triangle(3)) });
  expect(hook.result.current.points).toEqual(triangle(3));
});

test("a second change is sent also where the zone is not shown any more when the first is answered", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.keep(triangle(3)));
  hook.unmount();
  await act(() => Promise.resolve(waiting[0]?.answer(200)));
  await sent(2);
  expect(waiting[1]?.sent).toEqual(triangle(3));
});

test("a refused change is taken back, and what was changed since then is not", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.show(triangle(3)));
  await act(() => Promise.resolve(waiting[0]?.answer(422)));
  expect(hook.result.current.points).toEqual(triangle(3));
  act(() => hook.result.current.keep());
  await sent(2);
  await act(() => Promise.resolve(waiting[1]?.answer(422)));
  await waitFor(() => expect(hook.result.current.points).toEqual(triangle(1)));
});
