// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { ReviewBar } from "./ReviewBar";

testsPages();

const REVIEW = { needed: 1, history: [], why_not: "", may_run: false, compare_with: null, errors: 0, warnings: 0 };
const OF_ADMIN = { program: "p", role: "admin" } as const;

test.each([
  ["an approval", "4", ["Approve"]],
  ["a request", "draft", ["Ask for review", "Ask"]],
])("%s that is refused is told who has left the version", async (_, side, presses) => {
  const { nth } = slowServer({
    "/review?version=4": { ...REVIEW, number: 4 },
    "/review": { ...REVIEW, number: null, why_not: "own" },
  });
  const { leave } = showWithCorner(<ReviewBar {...OF_ADMIN} asked={["3", side]} onSince={() => undefined} />);
  for (const press of presses) fireEvent.click(await screen.findByText(press));
  const asked = await nth(1);
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});
