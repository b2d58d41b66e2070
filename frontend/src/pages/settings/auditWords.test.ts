import { afterEach, beforeAll, expect, test, vi } from "vitest";
import i18next from "i18next";
import type { AuditEntry } from "@/api/types";
import role from "@/i18n/en/role.json";
import people from "@/i18n/en/screens/people.json";
import { actorWords, byDay, dayWords, deedWords, placeWords } from "./auditWords";

const line = (code: string, facts: Record<string, unknown> = {}, some: Partial<AuditEntry> = {}): AuditEntry => ({
  id: 1,
  at: "2026-11-25T10:00:00",
  kind: "roles",
  code,
  actor_kind: "person",
  actor: "Ada Keller",
  address: "",
  browser: "",
  system: "",
  facts,
  ...some,
});

afterEach(() => void vi.unstubAllGlobals());
beforeAll(() => i18next.init({ lng: "en", resources: { en: { translation: { people, role } } } }));

test("roles are called as people call them", () => {
  expect(deedWords(line("role_changed", { person: "Tom West", before: "operator", after: "viewer" }))).toBe(
    "changed Tom West from Operator to Viewer",
  );
});

test("what differs by what it is made of has words of its own", () => {
  const run = { number: 12, program: "Paint order" };
  expect([
    deedWords(line("run_started", { ...run, armed: false })),
    deedWords(line("run_started", { ...run, armed: true })),
    deedWords(line("access_end_set", { person: "Tom West", until: null })),
    deedWords(line("invitation_made", { role: "viewer", days: 7, uses: 1, email: "tom@fab.example" })),
  ]).toEqual([
    "started run 12 of Paint order",
    "armed Paint order, which started run 12",
    "took away the end of access of Tom West",
    "sent an invitation to tom@fab.example: Viewer, 7 days",
  ]);
});

test("why a device was not let ask is told in words", () => {
  const refused = line("device_turned_away", { device: "oven 1", because: "device_id" }, { kind: "devices" });
  expect(deedWords(refused)).toBe("refused oven 1, which asked to join: the id is not valid");
});

test("tokens and VIPO itself stand where people stand", () => {
  expect([
    actorWords(line("stop_reset", {}, { actor_kind: "token", actor: "Order desk" })),
    actorWords(line("stop_reset", {}, { actor_kind: "device", actor: "mixer1" })),
    actorWords(line("stop_reset", {}, { actor_kind: "vipo", actor: "" })),
  ]).toEqual(["Token Order desk", "mixer1", "VIPO"]);
});

test("as much is said of where it came from as is known", () => {
  const from = { address: "10.0.0.7", browser: "Firefox", system: "Linux" };
  expect([
    placeWords(line("stop_reset", {}, from)),
    placeWords(line("stop_reset", {}, { ...from, system: "" })),
    placeWords(line("stop_reset")),
  ]).toEqual(["from 10.0.0.7, Firefox on Linux", "from 10.0.0.7, Firefox", ""]);
});

test("lines of a day stand together", () => {
  const now = new Date("2026-11-25T12:00:00").getTime();
  const at = (id: number, time: string) => line("stop_reset", {}, { id, at: time });
  const lines = [at(4, "2026-11-25T11:00:00"), at(3, "2026-11-25T01:00:00"), at(2, "2026-11-24T23:00:00")];
  expect(byDay(lines, now).map(([day, of]) => [day, of.map((each) => each.id)])).toEqual([
    ["Today", [4, 3]],
    ["Yesterday", [2]],
  ]);
});

const HOUR_MS = 3_600_000;
const SUMMER = [Date.UTC(2026, 2, 29, 1), Date.UTC(2026, 9, 25, 1)] as const;
const ahead = (at: number) => (at >= SUMMER[0] && at < SUMMER[1] ? 2 : 1) * HOUR_MS;

/** The clock of a browser in Berlin; a process has one zone, that of the machine. */
class InBerlin extends Date {
  #wall = () => new Date(this.getTime() + ahead(this.getTime()));
  override toDateString = () => this.#wall().toISOString().slice(0, 10);
  override getDate = () => this.#wall().getUTCDate();
  override setDate = (day: number) => {
    const wall = this.#wall().setUTCDate(day);
    return this.setTime(wall - ahead(wall - ahead(wall)));
  };
}

test.each([
  ["2026-03-30T00:30:00+02:00", "2026-03-29T00:10:00+01:00", "2026-03-28T23:50:00+01:00"],
  ["2026-10-25T23:30:00+01:00", "2026-10-24T00:10:00+02:00", "2026-10-23T23:50:00+02:00"],
])("yesterday is the day before, also where one is longer or shorter: %s", (now, yesterday, before) => {
  vi.stubGlobal("Date", InBerlin);
  vi.stubGlobal("navigator", { languages: [] });
  const at = new Date(now).getTime();
  expect([dayWords(now, at), dayWords(yesterday, at)]).toEqual(["Today", "Yesterday"]);
  expect(dayWords(before, at)).not.toBe("Yesterday");
});
