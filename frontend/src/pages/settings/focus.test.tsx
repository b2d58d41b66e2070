// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Invitation, Member, MemberDetail, WallScreen } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { FactorRule } from "./FactorRule";
import { Invitations } from "./Invitations";
import { MemberTable } from "./MemberTable";
import { useInvitations, useMembers } from "./people";
import { WallScreens } from "./WallScreens";

testsPages();

const SOON = "2026-12-24T08:00:00Z";
const INVITATION = { id: 1, role: "viewer", state: "open", people: [], made_at: SOON, expires_at: SOON, uses: 1 };
const SCREEN = { id: 1, name: "East", seen_at: null, expires_at: SOON, expired: false } as WallScreen;
const BO = { id: 7, name: "Bo", role: "viewer", sign_in_by: [], seen_at: null, ends_at: null, me: false };
const ENDING = { tokens: [], invitations: 0, signs_out: false, wall_screens_left: [] };

const members = [BO] as unknown as Member[];
const invitations = [INVITATION] as unknown as Invitation[];

function Asked() {
  const asked = useInvitations("hall").data?.invitations;
  return asked ? <Invitations slug="hall" invitations={asked} onNew={() => undefined} /> : null;
}

function People() {
  const asked = useMembers("hall").data;
  return asked ? <MemberTable slug="hall" members={asked} manages /> : null;
}

const focused = () => document.activeElement?.textContent;

/** Presses by keyboard, as a browser does: what is pressed has the focus. */
function press(element: HTMLElement) {
  element.focus();
  fireEvent.click(element);
}

test("who has turned off a wall screen goes on at the heading of those that are left", async () => {
  const screens = [SCREEN];
  const { nth } = slowServer({ "/wall-screens": screens });
  showWithCorner(<WallScreens slug="hall" />);
  press(await screen.findByLabelText("Turn off the wall screen East"));
  const asked = await nth(1);
  screens.pop();
  await asked.answer(200, {});
  await waitFor(() => expect(focused()).toBe("Wall screens"));
});

test("who has revoked an invitation goes on at the heading of all", async () => {
  const shown = [...invitations];
  const { nth } = slowServer({ "/invitations": { invitations: shown, can_mail: false } });
  showWithCorner(<Asked />);
  press(await screen.findByLabelText(/^Revoke the invitation/));
  const asked = await nth(1);
  shown[0] = { ...invitations[0], state: "revoked" } as Invitation;
  await asked.answer(200, {});
  await waitFor(() => expect(focused()).toBe("Invitations by link"));
});

test("one that goes by another hand takes nobody's focus along", async () => {
  const screens = [SCREEN, { ...SCREEN, id: 2, name: "West" }];
  const { nth } = slowServer({ "/wall-screens": screens });
  showWithCorner(<WallScreens slug="hall" />);
  fireEvent.click(await screen.findByLabelText("Turn off the wall screen West"));
  const asked = await nth(1);
  screens.shift();
  await asked.answer(409);
  await waitFor(() => expect(screen.queryByText("East")).toBeNull());
  expect(document.activeElement).toBe(document.body);
});

test("who has removed a member goes on at the heading of the members", async () => {
  const shown = [...members];
  const detail = { ...BO, ending: ENDING } as unknown as MemberDetail;
  const { nth } = slowServer({ "/members": shown, "/members/7": detail });
  showWithCorner(<People />);
  press(await screen.findByLabelText("More for Bo"));
  press((await screen.findByText("Remove…")).closest("button") as HTMLElement);
  const go = (await screen.findByText("Remove", { selector: "button *" })).closest("button") as HTMLButtonElement;
  await waitFor(() => expect(go.disabled).toBe(false));
  press(go);
  const asked = await nth(1);
  shown.pop();
  await asked.answer(200, {});
  await waitFor(() => expect(focused()).toBe("Members"));
});

test.each([
  ["Role of Bo", <MemberTable key="" slug="hall" members={members} manages />, "author", "admin"],
  ["Demanded of", <FactorRule key="" slug="hall" />, "admin", "author"],
])(
  "while what was chosen is being set its field keeps the focus, and takes nothing else: %s",
  async (label, shown, ...values) => {
    const { waiting, nth } = slowServer({ "/second-factor": { demanded_from: null, of_server: null } });
    showWithCorner(shown);
    const field = await screen.findByLabelText<HTMLSelectElement>(label);
    const choose = (value: string | undefined) => fireEvent.change(field, { target: { value } });
    choose(values[0]);
    const first = await nth(1);
    await waitFor(() => expect(field.getAttribute("aria-disabled")).toBe("true"));
    expect(field.disabled).toBe(false);
    choose(values[1]);
    await new Promise((done) => setTimeout(done, 50));
    expect(waiting).toHaveLength(1);
    await first.answer(200, {});
    await waitFor(() => expect(field.getAttribute("aria-disabled")).toBe("false"));
    choose(values[1]);
    await nth(2);
  },
);
