import { beforeEach, expect, test } from "vitest";
import type { OpenProgram } from "../state/context";
import { resetUi, useUi } from "../state/ui";
import { pasteIfScript } from "./pasting";

beforeEach(resetUi);

const open = { t: (key: string) => key } as unknown as OpenProgram;
const cut = () => Promise.reject(new TypeError("Failed to fetch dynamically imported module"));

test("a paste whose reader cannot be fetched says what to do", async () => {
  expect(pasteIfScript(open, "self.wait(5)", cut)).toBe(true);
  await expect.poll(() => useUi.getState().toast?.text).toBe("script.paste_unloaded");
});

test("what is no script is left to others", () => {
  expect(pasteIfScript(open, "Buy milk", cut)).toBe(false);
});
