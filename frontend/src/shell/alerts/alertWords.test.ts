import i18next from "i18next";
import { beforeAll, expect, test } from "vitest";
import type { Alert } from "@/api/types";
import type { DeviceEvent, Fault } from "@/api/types";
import { ownWords } from "./alertWords";
import problems from "@/i18n/de/problems.json";
import device from "@/i18n/de/screens/device.json";
import fault from "@/i18n/de/screens/fault.json";
import { deviceEventWords } from "@/i18n/deviceEvents";
import { faultWords, isKnownFault } from "@/i18n/faults";
import { refusalWords } from "@/i18n/refusals";

beforeAll(() =>
  i18next.init({
    lng: "de",
    resources: { de: { translation: { device, fault, problems } } },
    interpolation: { escapeValue: false },
  }),
);

const twice: Fault = {
  text: "The description names the key 'a<b' twice. Remove one.",
  line: 2,
  column: 5,
  path: "",
  code: "json_twice",
  args: { it: "The description", key: "a<b" },
};
const colon: Fault = { ...twice, code: "mended_colon", column: 0, args: { key: "methods" } };

function line(args: Record<string, unknown>, code = "problem"): DeviceEvent {
  return { at: "", kind: code, text: "desc: English", code, args, by: "", changes: [] };
}

test("a fault is told in the language of the screen, with its place", () => {
  expect(faultWords(twice)).toBe("Der Schlüssel „a<b“ kommt zweimal vor. Entfernen Sie einen davon.");
  expect(refusalWords("bad_description", { faults: [twice] })).toBe(
    "Zeile 2, Spalte 5: Der Schlüssel „a<b“ kommt zweimal vor. Entfernen Sie einen davon.",
  );
});

test("a sentence without a code stays as it is", () => {
  const bare = { ...twice, code: "", text: "Whole maps come too fast." };
  expect([faultWords(bare), isKnownFault(bare)]).toEqual(["Whole maps come too fast.", false]);
  expect(faultWords({ ...twice, code: "of tomorrow" })).toBe(twice.text);
});

test("a line of history says what was refused and how often", () => {
  expect(deviceEventWords(line({ faults: [twice], kind: "desc", more: 3, text: "desc: English" }))).toBe(
    "Beschreibung nicht angenommen: Zeile 2, Spalte 5: Der Schlüssel „a<b“ kommt zweimal vor. Entfernen Sie einen davon. (und 3 weitere seit der letzten Zeile)",
  );
  expect(deviceEventWords(line({ faults: [colon], text: "Line 2: put …" }, "mended"))).toBe(
    "Beim Lesen berichtigt: Zeile 2: Hinter methods wurde ein Doppelpunkt ergänzt.",
  );
});

test("an older line is told in the words it was written in", () => {
  expect(deviceEventWords(line({ text: "desc: English" }))).toBe("Nicht angenommen: desc: English");
  expect(deviceEventWords(line({}, ""))).toBe("desc: English");
});

test("an alert tells why in the language of the screen, an older one in its own words", () => {
  const alert = { args: { why: "English", faults: [{ ...twice, line: 0, path: "/a" }] } } as unknown as Alert;
  expect(ownWords(alert)).toBe("/a Der Schlüssel „a<b“ kommt zweimal vor. Entfernen Sie einen davon.");
  expect(ownWords({ ...alert, args: { why: "English" } })).toBe("English");
});
