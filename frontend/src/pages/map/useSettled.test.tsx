// @vitest-environment jsdom
import { act, cleanup, renderHook } from "@testing-library/react";
import { afterEach, expect, test } from "vitest";
import { useSettled } from "./useSettled";

afterEach(cleanup);

/** A field, and what it asked to keep; `answer` takes or refuses the first that waits. */
function begun(known: string) {
  const waiting: { value: string; answer: (isTaken: boolean) => void }[] = [];
  const keep = (value: string) => new Promise<boolean>((answer) => waiting.push({ value, answer }));
  const { result, rerender } = renderHook(({ now }) => useSettled(now, keep), { initialProps: { now: known } });
  return {
    asked: () => waiting.map(({ value }) => value),
    shown: () => result.current.value,
    type: (value: string) => act(() => result.current.setValue(value)),
    settle: (value: string) => act(() => result.current.settle(value)),
    /** What the server has is told before its answer to the change. */
    answer: async (at: number, isTaken: boolean, now: string) => {
      rerender({ now });
      await act(async () => Promise.resolve(waiting[at]?.answer(isTaken)));
    },
    tell: (now: string) => rerender({ now }),
  };
}

test("of two values that are set in a row the second one stays, and is not sent again", async () => {
  const { asked, shown, settle, answer } = begun("A");
  settle("B");
  settle("C");
  await answer(0, true, "B");
  expect(shown()).toBe("C");
  settle(shown()); // the field is left
  await answer(1, true, "C");
  expect([asked(), shown()]).toEqual([["B", "C"], "C"]);
});

test("what is typed while another value is being kept stays", async () => {
  const { shown, settle, type, answer } = begun("A");
  settle("B");
  type("Bay 7");
  await answer(0, true, "B");
  expect(shown()).toBe("Bay 7");
});

test("what others set is shown where nothing was typed, and what the server made of a value", async () => {
  const { shown, settle, answer, tell } = begun("A");
  tell("Their own");
  expect(shown()).toBe("Their own");
  settle("B ");
  await answer(0, true, "Their own");
  tell("B");
  expect(shown()).toBe("B");
});

test("what somebody set right behind it is shown, though it is known before the answer", async () => {
  const { asked, shown, settle, answer } = begun("A");
  settle("B");
  await answer(0, true, "Their own");
  expect(shown()).toBe("Their own");
  settle(shown()); // the field is left
  expect(asked()).toEqual(["B"]);
});

test("a value that is refused gives way to what holds by then", async () => {
  const { shown, settle, answer } = begun("A");
  settle("B");
  await answer(0, false, "D");
  expect(shown()).toBe("D");
});
