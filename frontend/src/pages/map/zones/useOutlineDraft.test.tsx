// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { notifications, Notifications } from "@mantine/notifications";
import { QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, render, renderHook, screen, waitFor } from "@testing-library/react";
import type { ReactNode } from "react";
import { afterEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import type { MapZone } from "@/api/types";
import { slowServer } from "@/testing/slowServer";
import type { Outline } from "./outline";
import { useOutlineDraft } from "./useOutlineDraft";

afterEach(() => {
  cleanup();
  notifications.clean();
  vi.unstubAllGlobals();
});

const triangle = (x: number): Outline => [
  [0, 0],
  [x, 0],
  [0, 1],
];
const zoneOf = (points: Outline) => ({ id: "aisle", points }) as unknown as MapZone;

/** A zone that is drawn with its present outline, and the corner where refusals are told. */
function begun() {
  const { waiting, nth: sent } = slowServer();
  const queries = makeQueryClient();
  const wrapper = ({ children }: { children: ReactNode }) => (
    <QueryClientProvider client={queries}>{children}</QueryClientProvider>
  );
  render(<Notifications />, { wrapper: MantineProvider });
  const hook = renderHook(({ zone }) => useOutlineDraft("hall", zone), {
    wrapper,
    initialProps: { zone: zoneOf(triangle(1)) },
  });
  return { waiting, hook, sent };
}

test("what is dragged when the answer to the change before comes stays in hand", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.show(triangle(3)));
  await waiting[0]?.answer(200);
  hook.rerender({ zone: zoneOf(triangle(2)) });
  expect(hook.result.current.points).toEqual(triangle(3));
  act(() => hook.result.current.keep());
  await sent(2);
  expect(waiting[1]?.sent).toEqual({ points: triangle(3) });
});

test("a second change waits for the first and is sent then", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.keep(triangle(3)));
  hook.rerender({ zone: zoneOf(triangle(2)) });
  expect(hook.result.current.points).toEqual(triangle(3));
  await waiting[0]?.answer(200);
  await sent(2);
  expect(waiting[1]?.sent).toEqual({ points: triangle(3) });
  await waiting[1]?.answer(200);
  hook.rerender({ zone: zoneOf(triangle(3)) });
  expect(hook.result.current.points).toEqual(triangle(3));
});

test("a second change is sent also where the zone is not shown any more when the first is answered", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.keep(triangle(3)));
  hook.unmount();
  await waiting[0]?.answer(200);
  await sent(2);
  expect(waiting[1]?.sent).toEqual({ points: triangle(3) });
});

test("a refused change is taken back, and what was changed since then is not", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.show(triangle(3)));
  await waiting[0]?.answer(422);
  expect(hook.result.current.points).toEqual(triangle(3));
  act(() => hook.result.current.keep());
  await sent(2);
  await waiting[1]?.answer(422);
  await waitFor(() => expect(hook.result.current.points).toEqual(triangle(1)));
});

test("a change that is refused when the zone is not shown any more is told, the first as the one behind it", async () => {
  const { waiting, hook, sent } = begun();
  act(() => hook.result.current.keep(triangle(2)));
  await sent(1);
  act(() => hook.result.current.keep(triangle(3)));
  hook.unmount();
  await waiting[0]?.answer(422);
  await waitFor(() => expect(screen.getAllByRole("alert")).toHaveLength(1));
  await sent(2);
  await waiting[1]?.answer(422);
  await waitFor(() => expect(screen.getAllByRole("alert")).toHaveLength(2));
});
