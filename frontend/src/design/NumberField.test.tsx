// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { act, cleanup, render, screen } from "@testing-library/react";
import i18next from "i18next";
import { useState } from "react";
import { initReactI18next } from "react-i18next";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { NumberField } from "./NumberField";

const told = vi.fn();

/** A form that keeps numbers alone. */
function Form() {
  const [width, setWidth] = useState<number | null>(1.5);
  return (
    <MantineProvider>
      <NumberField
        value={width ?? ""}
        min={0.05}
        onChange={(next) => {
          told(next);
          setWidth(next === "" ? null : next);
        }}
      />
    </MantineProvider>
  );
}

beforeEach(async () => {
  // Files share what is loaded: the texts of another one stay.
  if (!i18next.isInitialized) await i18next.use(initReactI18next).init({ lng: "en", resources: {} });
  await i18next.changeLanguage("en");
});
afterEach(async () => {
  cleanup();
  await i18next.changeLanguage("en");
  vi.unstubAllGlobals();
  told.mockReset();
});

const field = () => screen.getByRole<HTMLInputElement>("textbox");
/** As the browser does it, past React, which hears of it by the event. */
const write = (value: string) => Reflect.set(HTMLInputElement.prototype, "value", value, field());

/** Empty the field, then press a key for each character. */
function type(text: string): void {
  const put = (value: string, key: string) =>
    act(() => {
      field().focus();
      field().setSelectionRange(field().value.length, field().value.length);
      field().dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
      write(value);
      field().setSelectionRange(value.length, value.length);
      field().dispatchEvent(new Event("input", { bubbles: true }));
    });
  put("", "Backspace");
  for (const character of text) put(field().value + character, character);
}

function paste(text: string): void {
  type("");
  const event = Object.assign(new Event("paste", { bubbles: true, cancelable: true }), {
    clipboardData: { getData: () => text },
  });
  act(() => void field().dispatchEvent(event));
  if (!event.defaultPrevented) type(text);
}

test("a number has the decimal sign of the screen's language, and either may be typed or pasted", async () => {
  render(<Form />);
  for (const [language, sign] of [
    ["de", ","],
    ["en", "."],
  ] as const) {
    await act(() => i18next.changeLanguage(language));
    for (const bring of [type, paste])
      for (const text of ["2,05", "2.05"]) {
        bring(text);
        expect([field().value, told.mock.lastCall]).toEqual([`2${sign}05`, [2.05]]);
      }
    type(`${sign}25`);
    expect([field().value, told.mock.lastCall]).toEqual([`0${sign}25`, [0.25]]);
  }
});

test("a form that keeps numbers alone does not empty the field at a decimal sign", () => {
  render(<Form />);
  type("2.0");
  expect(told.mock.calls).toEqual([[""], [2]]);
  expect(field().value).toBe("2.0");
  act(() => field().blur());
  expect(field().value).toBe("2");
  type("-");
  expect([field().value, told.mock.lastCall]).toEqual(["-", [""]]);
  type("0.");
  act(() => field().blur());
  expect([field().value, told.mock.lastCall]).toEqual(["0.05", [0.05]]);
});
