// @vitest-environment jsdom
import { act, renderHook } from "@testing-library/react";
import { afterEach, expect, test, vi } from "vitest";
import { openUntil, useZonesAt } from "./openZones";

const AT = Date.parse("2026-11-28T14:00:00Z");

afterEach(() => vi.useRealTimers());

test("a zone is open until its time and not a moment longer", () => {
  const zone = { open_until: "2026-11-28T14:00:00+00:00" };
  expect([AT - 1, AT, AT + 1].map((now) => openUntil(zone, now))).toEqual([zone.open_until, null, null]);
  expect([null, undefined].map((until) => openUntil({ open_until: until }, AT))).toEqual([null, null]);
});

test("what is shown of zones is drawn anew when one of them shuts, and then when the next does", () => {
  vi.useFakeTimers({ now: AT - 60_000 });
  const first = { open_until: new Date(AT).toISOString() };
  const next = { open_until: new Date(AT + 5000).toISOString() };
  const zones = [first, next, {}];
  const { result } = renderHook(() => useZonesAt(zones));
  act(() => void vi.advanceTimersByTime(59_000));
  expect(result.current).toBe(AT - 60_000);
  act(() => void vi.advanceTimersByTime(1100));
  expect(openUntil(first, result.current)).toBeNull();
  expect(openUntil(next, result.current)).not.toBeNull();
  act(() => void vi.advanceTimersByTime(5000));
  expect(openUntil(next, result.current)).toBeNull();
  expect(vi.getTimerCount()).toBe(0);
});

test("a zone that has shut before anybody heard that it was open is not shown as open", () => {
  vi.useFakeTimers({ now: AT - 60_000 });
  const { result, rerender } = renderHook(({ zones }) => useZonesAt(zones), { initialProps: { zones: [{}] } });
  vi.setSystemTime(AT + 60_000);
  const late = { open_until: new Date(AT).toISOString() };
  rerender({ zones: [late] });
  expect(openUntil(late, result.current)).toBeNull();
});
