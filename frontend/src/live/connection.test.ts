import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { backOff, LiveConnection, SILENCE_MS } from "./connection";

/** A line whose other end the test plays. */
class Line {
  static all: Line[] = [];
  onmessage: ((event: { data: string }) => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;
  hungUp = false;

  constructor(readonly url: string) {
    Line.all.push(this);
  }

  say(text: string): void {
    this.onmessage?.({ data: JSON.stringify(text) });
  }

  close(): void {
    this.hungUp = true;
  }
}

let states: string[];
let heard: unknown[];
let refused: number[];
let connection: LiveConnection;

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("WebSocket", Line);
  vi.stubGlobal("window", new EventTarget());
  Line.all = [];
  [states, heard, refused] = [[], [], []];
  connection = new LiveConnection("ws://here", {
    onMessage: (message) => heard.push(message),
    onState: (state) => states.at(-1) !== state && states.push(state),
    onRefused: (code) => refused.push(code),
  });
});
afterEach(() => {
  connection.close();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

test("each attempt waits twice as long as the one before", () => {
  expect([0, 1, 2, 3, 4].map((attempt) => backOff(attempt, 1))).toEqual([300, 600, 1200, 2400, 4800]);
});

test("no wait is longer than eight seconds", () => {
  expect(backOff(5, 1)).toBe(8000);
  expect(backOff(2000, 1)).toBe(8000);
});

test("chance takes away up to half, so that browsers do not come back all at once", () => {
  expect(backOff(0, 0)).toBe(150);
  expect(backOff(0, 0.5)).toBe(225);
});

test("a line that has gone silent is left, though it never closes", () => {
  Line.all[0]?.say("hello");
  vi.advanceTimersByTime(SILENCE_MS - 1);
  Line.all[0]?.say("beat");
  vi.advanceTimersByTime(SILENCE_MS - 1);
  expect(states).toEqual(["connecting", "live"]);
  vi.advanceTimersByTime(1);
  expect(states).toEqual(["connecting", "live", "reconnecting"]);
  expect(Line.all[0]?.hungUp).toBe(true);
  vi.advanceTimersByTime(300);
  Line.all[1]?.say("hello");
  Line.all[0]?.say("late");
  expect(states.at(-1)).toBe("live");
  expect(heard).toEqual(["hello", "beat", "hello"]);
});

test("what the browser says of its network is believed at once", () => {
  Line.all[0]?.say("hello");
  window.dispatchEvent(new Event("offline"));
  expect(states.at(-1)).toBe("reconnecting");
  window.dispatchEvent(new Event("online"));
  expect(Line.all).toHaveLength(2);
  window.dispatchEvent(new Event("online"));
  vi.advanceTimersByTime(1000);
  expect(Line.all).toHaveLength(2);
});

test("a refusal is final", () => {
  Line.all[0]?.onclose?.({ code: 4401 });
  window.dispatchEvent(new Event("online"));
  vi.advanceTimersByTime(60_000);
  expect(refused).toEqual([4401]);
  expect(Line.all).toHaveLength(1);
});

test("where too many are open already it is tried again, slowly, until one has gone", () => {
  Line.all[0]?.onclose?.({ code: 4429 });
  vi.advanceTimersByTime(14_000);
  expect([states.at(-1), Line.all.length]).toEqual(["crowded", 1]);
  vi.advanceTimersByTime(16_000);
  Line.all[1]?.onclose?.({ code: 4429 });
  vi.advanceTimersByTime(30_000);
  Line.all[2]?.say("hello");
  expect(states).toEqual(["connecting", "crowded", "live"]);
  expect(refused).toEqual([]);
});
