import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import run from "@/i18n/de/run.json";
import simulation from "@/i18n/de/screens/simulation.json";
import { logWords } from "./logWords";

const nameOf = (id: string) => ({ robot01: "Kiwi" })[id] ?? id;
const line = (code: string, args: Record<string, string | number | boolean> = {}) =>
  logWords({ device: "robot01", text: "as written", code, args }, nameOf);

beforeAll(() => i18next.init({ lng: "de", resources: { de: { translation: { run, simulation } } } }));

test("lines of a rehearsal are told by their code in the language of the screen", () => {
  expect(line("way", { length_m: 3.5 })).toBe("Kiwi fährt los, 3.5 m.");
  expect(line("answered_itself", { value: true })).toBe("Die Probe antwortet selbst: Ja");
  expect(line("answered_itself", { value: "" })).toBe("Die Probe antwortet selbst: nichts");
  expect(line("answer", { method: "pick", status: "DONE", why: "" })).toBe("Kiwi, pick: erledigt");
  expect(line("answer", { method: "pick", status: "FAILED", why: "No box." })).toBe(
    "Kiwi, pick: fehlgeschlagen. No box.",
  );
  expect(line("fault_wrong_value")).toBe("Absichtlich, Kiwi: zeigt einen falschen Wert");
  expect(line("step_offline", { why: "Gone." })).toBe("Nicht verbunden: Gone.");
});

test("what has no code, or one that is not known, is shown as it was written", () => {
  expect(line("")).toBe("as written");
  expect(line("something_new")).toBe("as written");
  expect(logWords({ device: "", text: "of an older rehearsal" }, nameOf)).toBe("of an older rehearsal");
});
