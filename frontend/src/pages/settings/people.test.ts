import { expect, test } from "vitest";
import type { Member } from "@/api/types";
import { dayOf, endOfDay, findMembers, isLastAdmin } from "./people";

const member = (id: number, some: Partial<Member> = {}): Member => ({
  id,
  name: `Person ${id}`,
  initials: "P",
  email: `person${id}@fab.example`,
  role: "admin",
  joined_at: null,
  seen_at: null,
  ends_at: null,
  came_by: "",
  is_closed: false,
  second_factor: false,
  has_password: true,
  sign_in_by: [],
  me: false,
  ...some,
});

test("the only admin is the last one", () => {
  const members = [member(1), member(2, { role: "author" })];
  expect(members.map((each) => isLastAdmin(each, members))).toEqual([true, false]);
});

test("an admin whose access ends, or whose account is closed, is no other one", () => {
  const members = [member(1), member(2, { ends_at: "2026-11-30T23:59:59Z" }), member(3, { is_closed: true })];
  expect(members.map((each) => isLastAdmin(each, members))).toEqual([true, false, false]);
});

test("of two admins none is the last", () => {
  const members = [member(1), member(2)];
  expect(members.map((each) => isLastAdmin(each, members))).toEqual([false, false]);
});

test("members are found by name and by address", () => {
  const members = [member(1, { name: "Nora Lind" }), member(2, { email: "tom@kiln.example" })];
  const found = (typed: string) => findMembers(members, typed).map((each) => each.id);
  expect([found(" nora"), found("KILN"), found(""), found("nobody")]).toEqual([[1], [2], [1, 2], []]);
});

test("a day ends with its last second where one looks", () => {
  expect(endOfDay("2026-11-30")).toBe(new Date(2026, 10, 30, 23, 59, 59).toISOString());
  expect([endOfDay(""), endOfDay("soon")]).toEqual([undefined, undefined]);
});

test("the day of a day's end is that day", () => {
  const days = ["2026-03-29", "2026-07-01", "2026-10-25", "2026-12-31"]; // two of them are longer or shorter in Europe
  expect(days.map((day) => dayOf(new Date(endOfDay(day) ?? "")))).toEqual(days);
});
