// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { afterEach, expect, test } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import type { Device } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { useDecide, type Decision } from "./decisions";
import { KeyShown } from "./keys/KeyShown";
import { useShownKeys } from "./keys/shownKey";

testsPages();
afterEach(() => useShownKeys.setState([], true));

const device = (id: string, name: string) => ({ id, name, lifecycle: "approved" }) as Device;
const MILL = device("mill", "Mill");

function Deciding({ decisions }: { decisions: Decision[] }) {
  const { mutate } = useDecide("hall");
  return (
    <>
      <button onClick={() => decisions.forEach((each) => mutate(each))}>Decide</button>
      <KeyShown />
    </>
  );
}

test("of two keys that are made one after the other each is shown, and none is lost", async () => {
  const { nth } = slowServer();
  const rotated = [MILL, device("saw", "Saw")].map((each): Decision => ({ do: "rotate", device: each }));
  showWithCorner(<Deciding decisions={rotated} />);
  fireEvent.click(screen.getByText("Decide"));
  await (await nth(1)).answer(200, { credential: "first-key" });
  await (await nth(2)).answer(200, { credential: "second-key" });
  expect(await screen.findByDisplayValue("first-key")).toBeTruthy();
  expect(screen.getByText("Key of Mill")).toBeTruthy();
  fireEvent.click(screen.getByText("I have it"));
  expect(await screen.findByDisplayValue("second-key")).toBeTruthy();
  fireEvent.click(screen.getByText("I have it"));
  await waitFor(() => expect(screen.queryByDisplayValue("second-key")).toBeNull());
});

test("what RDF says of a device is asked for anew once the device has another name", async () => {
  const { nth } = slowServer();
  const queries = makeQueryClient();
  const [of, other] = [
    [...keys.rdf("hall", "mill"), "turtle"],
    [...keys.rdf("hall", "saw"), "turtle"],
  ];
  for (const key of [of, other]) queries.setQueryData(key, "<mill>");
  showWithCorner(<Deciding decisions={[{ do: "rename", device: MILL, name: "Big mill" }]} />, queries);
  fireEvent.click(screen.getByText("Decide"));
  await (await nth(1)).answer(200, {});
  const isOld = (key: readonly string[] | undefined) => queries.getQueryState(key as string[])?.isInvalidated;
  await waitFor(() => expect(isOld(of)).toBe(true));
  expect(isOld(other)).toBe(false);
});
