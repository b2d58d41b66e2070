import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import type { RunEvent } from "@/api/types";
import reason from "@/i18n/de/screens/reason.json";
import de from "@/i18n/de/run.json";
import { waitWords } from "@/i18n/waits";
import { eventWords } from "./eventWords";

const nameOf = (id: string) => ({ robot01: "Kiwi", robot02: "Mango", oven: "Ofen" })[id] ?? id;
const event = (more: Partial<RunEvent>) =>
  ({ kind: "run", code: "", text: "as written", args: {}, ...more }) as RunEvent;

beforeAll(() => i18next.init({ lng: "de", resources: { de: { translation: { run: de, reason } } } }));

test("a wait is told in the language of the screen with people's names for things", () => {
  expect(waitWords({ code: "machine_busy", args: { device: "oven", run: "run 7" } }, nameOf)).toBe(
    "Ofen arbeitet gerade für Lauf 7.",
  );
  expect(waitWords({ code: "machine_busy", args: { device: "oven" } }, nameOf)).toBe("Ofen ist beschäftigt.");
  expect(waitWords({ code: "blocked_by", args: { robot: "robot01", others: "robot02,oven" } }, nameOf)).toBe(
    "Kiwi lässt Mango und Ofen vorbei.",
  );
});

test("a reason that the screen does not know has no words of its own", () => {
  expect(waitWords({ code: "something_new", args: {} }, nameOf)).toBeNull();
  expect(waitWords(null, nameOf)).toBeNull();
});

test("lines of the journal are told by their code, others as they were written", () => {
  expect(eventWords(event({ code: "answered", args: { by: "Ada", value: false } }), nameOf)).toBe(
    "Ada hat geantwortet: Nein",
  );
  expect(eventWords(event({ kind: "wait", code: "offline", device: "oven" }), nameOf)).toBe(
    "Ofen ist nicht verbunden.",
  );
  const answer = { kind: "answer", code: "answer", device: "robot01" };
  expect(eventWords(event({ ...answer, args: { method: "pick", status: "DONE", why: "" } }), nameOf)).toBe(
    "Kiwi ist fertig: pick.",
  );
  expect(eventWords(event({ ...answer, args: { method: "pick", status: "FAILED", why: "No box." } }), nameOf)).toBe(
    "Kiwi ist gescheitert: pick (No box.)",
  );
  expect(eventWords(event({ kind: "notice", code: "told", text: "Boxes: 4" }), nameOf)).toBe("Boxes: 4");
  expect(eventWords(event({ kind: "step", code: "step_failed", text: "Why." }), nameOf)).toBe("Why.");
});

test("why something was not done is told in the language of the screen, a device's own words in quotes", () => {
  const offline = { code: "offline", args: { device: "Ofen" } };
  expect(eventWords(event({ kind: "step", code: "step_offline", cause: offline }), nameOf)).toBe("Ofen ist offline.");
  expect(eventWords(event({ code: "failed", cause: offline }), nameOf)).toBe(
    "Der Lauf ist fehlgeschlagen: Ofen ist offline.",
  );
  const own = { code: "said", args: { words: "Lid open" } };
  expect(eventWords(event({ kind: "step", code: "step_failed", cause: own }), nameOf)).toBe("„Lid open“");
});
