// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Token } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { AskRevoke } from "./TokensPage";

testsPages();

test("who has closed the question before the end of a token is refused is told", async () => {
  const { nth } = slowServer();
  const token = { id: "1", name: "Display" } as Token;
  const { leave } = showWithCorner(<AskRevoke slug="hall" token={token} onClose={() => undefined} />);
  fireEvent.click(screen.getByText("Revoke"));
  const asked = await nth(1);
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});
