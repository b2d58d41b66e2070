// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { SecondFactor } from "./SecondFactor";

testsPages();

const fill = (label: string, value: string) => fireEvent.change(screen.getByLabelText(label), { target: { value } });
const escape = () => fireEvent.keyDown(screen.getByRole("dialog"), { key: "Escape" });
const button = (words: string) => screen.getByText(words, { selector: "[role=dialog] button *" }).closest("button");

/** New recovery codes are asked for. */
async function renewing() {
  const factor = { since: "2026-11-30T08:00:00Z", recovery_codes: 3 };
  const { nth } = slowServer({ "/second-factor": factor, "/ways-in": { has_password: true, providers: [] } });
  const { leave } = showWithCorner(<SecondFactor />);
  fireEvent.click(await screen.findByText("New recovery codes"));
  await screen.findByRole("dialog");
  fill("Your password", "four odd words");
  fill("Code of your app, or a recovery code", "123456");
  fireEvent.click(button("New recovery codes") as HTMLElement);
  return { asked: await nth(1), leave };
}

test("codes that are told once are shown at once, also to who would have closed the dialog", async () => {
  const { asked } = await renewing();
  escape();
  expect(button("Cancel")?.disabled).toBe(true);
  const answers = vi.fn(() => new Promise(() => undefined));
  vi.stubGlobal("fetch", answers); // what is read anew does not come
  await asked.answer(200, { codes: ["first-code", "second-code"] });
  expect(await screen.findByText("first-code")).toBeTruthy();
  await waitFor(() => expect(answers).toHaveBeenCalled());
  escape();
  fireEvent.click(screen.getByText("I have them"));
  await waitFor(() => expect(document.activeElement?.textContent).toBe("Second factor"));
  expect(screen.queryByText("first-code")).toBeNull();
});

test("a proof that is refused can be given up", async () => {
  const { asked } = await renewing();
  await asked.answer(409);
  expect(await screen.findAllByText("No.")).toHaveLength(1);
  escape();
  await waitFor(() => expect(screen.queryByRole("dialog")).toBeNull());
});

test("who has left the page before a proof is refused is told", async () => {
  const { asked, leave } = await renewing();
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});
