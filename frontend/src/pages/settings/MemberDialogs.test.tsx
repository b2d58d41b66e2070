// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import type { Member } from "@/api/types";
import { show, showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { AccessEnd, AskLeave, AskRemove, AskReset } from "./MemberDialogs";

testsPages();

test.each([
  ["New York", 300, "2026-12-02T04:59:59Z"],
  ["Tokyo", -540, "2026-12-01T14:59:59Z"],
])("the last day of an access is the one that was set, in %s", (_, minutes, ends_at) => {
  vi.spyOn(Date.prototype, "getTimezoneOffset").mockReturnValue(minutes);
  const member = { id: 1, name: "Bo", ends_at } as Member;
  show(<AccessEnd slug="hall" member={member} onClose={() => undefined} />);
  expect(screen.getByLabelText<HTMLInputElement>("Last day").value).toBe("2026-12-01");
});

const BO = { id: 7, name: "Bo", ends_at: "2026-12-01T12:00:00Z" } as Member;
const ENDING = { tokens: [], invitations: 0, signs_out: false, wall_screens_left: ["East wall", "Gate 2"] };
const OF_BO = { slug: "hall", member: BO, onClose: () => undefined };

test.each([
  ["Set the end", () => <AccessEnd {...OF_BO} />],
  ["Remove", () => <AskRemove {...OF_BO} afterwards={() => null} />],
  ["Leave", () => <AskLeave {...OF_BO} />],
  ["Reset", () => <AskReset {...OF_BO} />],
])("who has closed the question before it is refused is told: %s", async (word, dialog) => {
  const { nth } = slowServer({ "/members/7": { ...BO, ending: ENDING } });
  const { leave } = showWithCorner(dialog());
  const go = screen.getByText(word, { selector: "button *" });
  await waitFor(() => expect(go.closest("button")?.disabled).toBe(false));
  fireEvent.click(go);
  const asked = await nth(1);
  leave();
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
});

test("who removes a member is told of their wall screens, which go on", async () => {
  slowServer({ "/members/7": { ...BO, ending: ENDING } });
  show(<AskRemove {...OF_BO} afterwards={() => null} />);
  expect(await screen.findByText(/^2 wall screens that they made go on: East wall, Gate 2\./)).toBeTruthy();
});
