// @vitest-environment jsdom
import { act, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { show, testsPages } from "@/testing/page";
import { useFreshRehearsal, useWhyUnknown } from "./rehearsal";

testsPages();
beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

function Shown() {
  const rehearsal = useFreshRehearsal("r");
  const why = useWhyUnknown("r", rehearsal);
  return <p>{rehearsal.data?.status ?? why ?? "unknown"}</p>;
}

const pass = (ms: number) => act(() => vi.advanceTimersByTimeAsync(ms));
const text = () => screen.getByRole("paragraph").textContent;

test("a rehearsal that is not there is asked for once", async () => {
  const fetched = vi.fn(() => Promise.resolve(Response.json({ code: "gone", detail: "No." }, { status: 404 })));
  vi.stubGlobal("fetch", fetched);
  show(<Shown />);
  await pass(3500);
  expect([fetched.mock.calls.length, text()]).toEqual([1, "No."]);
});

test("why a rehearsal cannot be read stays until it can be, while it is asked for again", async () => {
  const answers = [{ status: 500, body: { code: "broken", detail: "No." } }, null, null];
  const fetched = vi.fn(() => {
    const answer = answers[fetched.mock.calls.length - 1];
    const after = answer ? 0 : 600;
    const { status, body } = answer ?? { status: 200, body: { id: "r", status: "done" } };
    return new Promise((done) => setTimeout(() => done(Response.json(body, { status })), after));
  });
  vi.stubGlobal("fetch", fetched);
  show(<Shown />);
  await pass(1300);
  expect([fetched.mock.calls.length, text()]).toEqual([2, "No."]);
  await pass(700);
  expect(text()).toBe("done");
});

test("an answer that takes longer than it takes to ask again arrives, and the last one ends the asking", async () => {
  let asked = 0;
  vi.stubGlobal("fetch", () => {
    asked += 1;
    const status = asked === 1 ? "running" : "done";
    return new Promise((answer) => setTimeout(() => answer(Response.json({ id: "r", status })), asked > 1 ? 1500 : 0));
  });
  show(<Shown />);
  await pass(500);
  expect(text()).toBe("running");
  await pass(2500);
  expect(text()).toBe("done");
  await pass(5000);
  expect(asked).toBe(2);
});
