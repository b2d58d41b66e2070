import { expect, test } from "vitest";
import type { Thread } from "@/api/types";
import { countUnread, filterThreads } from "./threads";

const NO_MOMENT = { run: null, number: null, t_s: null };
const named = (id: number) => ({ id, name: "Ann", initials: "A" });

function thread(id: string, changes: Partial<Thread> = {}, mentions: number[] = []): Thread {
  const anchor = { kind: "program" as const, root: null, id: null, to: null, x: null, y: null, ...NO_MOMENT };
  const at = "2026-01-02T03:04:00Z";
  const comment = {
    id: `${id}-1`,
    author: null,
    text: "Why?",
    mentions: mentions.map(named),
    written_at: at,
    edited_at: null,
  };
  return {
    id,
    anchor,
    label: "",
    stands: true,
    started_at: at,
    resolved_at: null,
    resolved_by: null,
    comments: [comment],
    unread: 0,
    ...changes,
  };
}

const RESOLVED = { resolved_at: "2026-01-03T03:04:00Z" };

test("unread comments are counted in open threads alone", () => {
  expect(
    countUnread([thread("a", { unread: 2 }), thread("b", { unread: 1 }), thread("c", { unread: 4, ...RESOLVED })]),
  ).toBe(3);
});

test("threads are open, resolved, or mention somebody, whether resolved or not", () => {
  const all = [thread("a"), thread("b", {}, [7]), thread("c", RESOLVED, [7]), thread("d", RESOLVED)];
  const shown = (filter: "open" | "mine" | "resolved") => filterThreads(all, filter, 7).map((each) => each.id);
  expect(shown("open")).toEqual(["a", "b"]);
  expect(shown("mine")).toEqual(["b", "c"]);
  expect(shown("resolved")).toEqual(["c", "d"]);
  expect(filterThreads(all, "mine", undefined)).toEqual([]);
});
