// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { useState, type ReactNode } from "react";
import { expect, test } from "vitest";
import type { Invitation, Member, Site, WallScreen } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { NewToken } from "../tokens/NewToken";
import { FactorRule } from "./FactorRule";
import { Invitations } from "./Invitations";
import { MemberTable } from "./MemberTable";
import { NewInvitation } from "./NewInvitation";
import { WallScreens } from "./WallScreens";

testsPages();

const SOON = "2026-12-24T08:00:00Z";
const FIRST = { code: "refused", detail: "The first one." };

const member = (id: number, name: string) =>
  ({ id, name, role: "viewer", sign_in_by: [], seen_at: null, ends_at: null, me: false }) as unknown as Member;
const invitation = (id: number) =>
  ({
    id,
    role: "viewer",
    state: "open",
    people: [],
    made_at: SOON,
    expires_at: SOON,
    uses: 1,
  }) as unknown as Invitation;
const screenAt = (id: number, name: string) =>
  ({ id, name, seen_at: null, expires_at: SOON, expired: false }) as WallScreen;

test("a role that is refused is told, also where another one was set meanwhile", async () => {
  const { nth, waiting } = slowServer();
  showWithCorner(<MemberTable slug="hall" members={[member(1, "Ann"), member(2, "Bo")]} manages />);
  for (const name of ["Ann", "Bo"])
    fireEvent.change(screen.getByLabelText(`Role of ${name}`), { target: { value: "author" } });
  await (await nth(2)).answer(200, {});
  expect(await screen.findByText("Bo is Author now.")).toBeTruthy();
  await waiting[0]?.answer(409, FIRST);
  expect(await screen.findByText(FIRST.detail)).toBeTruthy();
});

test("so are an invitation and a wall screen that could not be ended", async () => {
  const { nth, waiting } = slowServer({ "/wall-screens": [screenAt(1, "East"), screenAt(2, "West")] });
  showWithCorner(
    <>
      <Invitations slug="hall" invitations={[invitation(1), invitation(2)]} onNew={() => undefined} />
      <WallScreens slug="hall" />
    </>,
  );
  for (const button of screen.getAllByText("Revoke")) fireEvent.click(button);
  await nth(2);
  await screen.findByText("East");
  for (const name of ["East", "West"]) fireEvent.click(screen.getByLabelText(`Turn off the wall screen ${name}`));
  await nth(4);
  for (const each of [...waiting].reverse()) await each.answer(409, { code: "refused", detail: `Not ${each.asked}` });
  const told = ["invitations/1", "invitations/2", "wall-screens/1", "wall-screens/2"];
  for (const each of told) expect(await screen.findByText(`Not DELETE /${each}`)).toBeTruthy();
});

test("a demand of second factors that is refused is told who has left the page", async () => {
  const { nth } = slowServer({ "/second-factor": { demanded_from: null, of_server: null } });
  const { leave } = showWithCorner(<FactorRule slug="hall" />);
  fireEvent.change(await screen.findByLabelText("Demanded of"), { target: { value: "admin" } });
  const asked = await nth(1);
  leave();
  await asked.answer(409, FIRST);
  expect(await screen.findByText(FIRST.detail)).toBeTruthy();
});

type Made = (what: object) => void;
type Form = (made: Made) => ReactNode;

/** A form that people close, and what came of it. */
function Closing({ form }: { form: Form }) {
  const [isClosed, close] = useState(false);
  const [made, setMade] = useState<object | null>(null);
  return (
    <>
      <button onClick={() => close(true)}>Close</button>
      {isClosed ? null : form(setMade)}
      {made ? <p>{JSON.stringify(made)}</p> : null}
    </>
  );
}

const noop = () => undefined;
const OF_HALL = { slug: "hall", onClose: noop };
const HALL = { slug: "hall", role: "viewer" } as Site;

const FORMS: readonly [what: string, go: string, form: Form][] = [
  ["an invitation", "Make the link", (made) => <NewInvitation {...OF_HALL} canMail onMade={made} />],
  ["a token", "Make the token", (made) => <NewToken site={HALL} onClose={noop} onMade={made} />],
];

async function askedAndClosed(go: string, form: Form) {
  const { nth } = slowServer();
  showWithCorner(<Closing form={form} />);
  const name = screen.queryByPlaceholderText("Line display");
  if (name) fireEvent.change(name, { target: { value: "Display" } });
  fireEvent.click(screen.getByText(go));
  const asked = await nth(1);
  fireEvent.click(screen.getByText("Close"));
  return asked;
}

test.each(FORMS)("%s is shown also to who has closed the form before it came", async (_, go, form) => {
  const asked = await askedAndClosed(go, form);
  await asked.answer(200, { secret: "abc" });
  expect(await screen.findByText('{"secret":"abc"}')).toBeTruthy();
});

test.each(FORMS)("%s that is refused is told who has closed the form", async (_, go, form) => {
  const asked = await askedAndClosed(go, form);
  await asked.answer(409, FIRST);
  expect(await screen.findByText(FIRST.detail)).toBeTruthy();
});

test.each([
  ["shown", 200],
  ["refused", 409],
] as const)("so is the link of a wall screen: %s", async (_, status) => {
  const { nth } = slowServer();
  showWithCorner(<WallScreens slug="hall" />);
  fireEvent.click(await screen.findByText("New wall screen"));
  fireEvent.change(await screen.findByLabelText("Where it hangs"), { target: { value: "East" } });
  fireEvent.click(screen.getByText("Make the link"));
  const asked = await nth(1);
  fireEvent.click(screen.getByText("Cancel"));
  await waitFor(() => expect(screen.queryByText("Make the link")).toBeNull());
  await asked.answer(status, { ...FIRST, name: "East", link: "https://wall/abc" });
  if (status === 200) expect(await screen.findByDisplayValue("https://wall/abc")).toBeTruthy();
  else expect(await screen.findByText(FIRST.detail)).toBeTruthy();
});
