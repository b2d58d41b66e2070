// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import { EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";
import { show, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { ProgramContext, type OpenProgram } from "../state/context";
import { NotTakenPanel } from "./NotTakenPanel";

testsPages();

test("a version that is kept as a program of its own has what was drawn while it was being saved", async () => {
  const server = slowServer();
  const drawn = (duration: number): ProgramDocument => ({
    ...EMPTY_DOCUMENT,
    steps: { wait: { kind: "wait", place: null, pos: [1, -1], params: { duration } } },
  });
  let document = drawn(1);
  let discarded: ProgramDocument | null = null;
  const shared = { getDocument: () => document, discard: () => Promise.resolve((discarded = document)) };
  const open = {
    document,
    shared,
    canEdit: true,
    site: { slug: "hall" },
    program: { id: "p", name: "Day" },
    t: (key: string) => key,
  } as unknown as OpenProgram;
  show(
    <ProgramContext value={open}>
      <NotTakenPanel reason="large" waiting={1} />
    </ProgramContext>,
  );
  fireEvent.click(screen.getByText("not_taken.save"));
  await (await server.nth(1)).answer(201, { id: "copy" });
  const first = await server.nth(2);
  document = drawn(2);
  await first.answer(200, {});
  const second = await server.nth(3);
  expect([first.sent, second.sent]).toEqual([drawn(1), drawn(2)]);
  expect([second.asked, discarded]).toEqual([first.asked, null]);
  await second.answer(200, {});
  await waitFor(() => expect(discarded).toEqual(drawn(2)));
  expect(server.waiting).toHaveLength(3);
});
