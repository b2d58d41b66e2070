// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import type { OwnSession } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { SessionList } from "./SessionList";

testsPages();

const WHEN = "2026-11-30T08:00:00Z";
const AWAY = { id: "1", browser: "Firefox", system: "Linux", here: false, begun_at: WHEN, seen_at: WHEN } as unknown;

/** A session whose end is answered so; it is there no more if it `goes`. */
async function ended(status: number, goes: boolean) {
  const sessions = [AWAY as OwnSession];
  const { nth } = slowServer({ "/me/sessions": sessions });
  showWithCorner(<SessionList ending={false} />);
  fireEvent.click(await screen.findByText("Sign out"));
  const asked = await nth(1);
  if (goes) sessions.pop();
  await asked.answer(status);
}

test("a session that could not be ended stays, and one is told why", async () => {
  await ended(409, false);
  expect(await screen.findByText("No.")).toBeTruthy();
  expect(screen.getByText("Firefox on Linux")).toBeTruthy();
});

test("one that has ended meanwhile just goes", async () => {
  await ended(404, true);
  await waitFor(() => expect(screen.queryByText("Firefox on Linux")).toBeNull());
  expect(screen.queryByText("No.")).toBeNull();
});
