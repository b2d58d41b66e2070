// @vitest-environment jsdom
import { type QueryClient } from "@tanstack/react-query";
import { act, fireEvent, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient, useMe } from "@/api/queries";
import type { Device } from "@/api/types";
import { useSiteLive } from "@/live/site";
import { EMPTY, useLiveStore } from "@/live/store";
import { useShownKeys } from "@/pages/devices/keys/shownKey";
import { useMembers } from "@/pages/settings/people";
import { SignInPage } from "@/pages/signin/SignInPage";
import { showAt, testsPages } from "@/testing/page";
import { forgetOthers } from "./onlyOwn";
import { RequireUser } from "./RequireUser";

/** A line to a server that the test plays. */
class Line {
  static all: Line[] = [];
  onmessage: ((event: { data: string }) => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;
  constructor() {
    Line.all.push(this);
  }
  close() {}
}

const meOf = (name: string | null) => {
  const user = name && { id: name.length, name, email: `${name}@fab.example`, initials: "X" };
  return { csrf: "", demo_accounts: [], may_create_sites: false, user };
};
const KEY = { device: "mixer", name: "Mixer", credential: "secret", taken: false };
let signedIn: string | null;
let queries: QueryClient;

/** A server at which Anna alone is a member of the site. */
function answer(path: string): Response {
  if (path === "/api/sign-in") signedIn = "Bartholomew";
  if (path === "/api/sign-in" || path === "/api/me") return Response.json(meOf(signedIn));
  if (path === "/api/sign-in/providers") return Response.json([]);
  if (signedIn === null) return Response.json({ code: "signed_out" }, { status: 401 });
  if (signedIn !== "Anna") return Response.json({ code: "not_found" }, { status: 404 });
  return Response.json([{ id: 3, name: "Carla" }]);
}

function People() {
  useSiteLive("hall");
  const members = useMembers("hall");
  const names = members.data?.map(({ name }) => name).join() ?? "nobody";
  return <main>{`${useMe().data?.user?.name} sees ${names}`}</main>;
}

testsPages();
beforeEach(async () => {
  vi.stubGlobal("WebSocket", Line);
  vi.stubGlobal("fetch", (path: string) => Promise.resolve(answer(path)));
  vi.stubGlobal("indexedDB", { databases: () => Promise.resolve([]) });
  [Line.all, signedIn] = [[], "Anna"];
  useLiveStore.setState(EMPTY);
  await openPage();
  useLiveStore.setState({ deviceById: { mixer: { id: "mixer" } as Device } });
  useShownKeys.setState([KEY, KEY], true);
});
afterEach(() => useShownKeys.setState([], true));

async function openPage() {
  queries = makeQueryClient();
  forgetOthers(queries);
  const people = { element: <RequireUser />, children: [{ path: "/people", element: <People /> }] };
  showAt("/people", [{ path: "/sign-in", element: <SignInPage /> }, people], queries);
  await expect.poll(text).toBe("Anna sees Carla");
}

const text = () => screen.queryByRole("main")?.textContent;
const known = () => [Object.keys(useLiveStore.getState().deviceById), useShownKeys.getState()];
const fill = (label: string, value: string) => fireEvent.change(screen.getByLabelText(label), { target: { value } });

test("who signs in where another's session has ended sees nothing of theirs", async () => {
  signedIn = null;
  act(() => Line.all[0]?.onclose?.({ code: 4401 }));
  await expect.poll(() => screen.queryByLabelText("Email address")).not.toBeNull();
  expect(known()).toEqual([[], []]);
  fill("Email address", "bartholomew@fab.example");
  fill("Password", "four odd words");
  fireEvent.click(screen.getByRole("button", { name: "Sign in" }));
  await expect.poll(text).toBe("Bartholomew sees nobody");
  await expect.poll(() => Line.all.length).toBe(2);
});

test("who signs in elsewhere in the same browser takes another's place with nothing of theirs", async () => {
  signedIn = "Bartholomew";
  await act(() => queries.refetchQueries({ queryKey: keys.me }));
  await expect.poll(text).toBe("Bartholomew sees nobody");
  expect(known()).toEqual([[], []]);
});

test("what was fetched stays while the same person is signed in", async () => {
  await act(() => queries.refetchQueries({ queryKey: keys.me }));
  expect([text(), known()]).toEqual(["Anna sees Carla", [["mixer"], [KEY, KEY]]]);
});
