// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { MapVersion, Site } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { AskBack } from "./MapVersions";

testsPages();

test("who has closed the question before the way back to a map is refused is told", async () => {
  const { nth } = slowServer();
  const site = { slug: "hall" } as Site;
  const [version, current] = [
    { version: 1, tag: '"hall-1-0"' },
    { version: 2, tag: '"hall-2-0"' },
  ] as MapVersion[];
  const { leave } = showWithCorner(
    <AskBack site={site} version={version as MapVersion} current={current as MapVersion} onClose={() => undefined} />,
  );
  fireEvent.click(screen.getByText("Use again"));
  const asked = await nth(1);
  leave();
  await asked.answer(412);
  expect(await screen.findByText("No.")).toBeTruthy();
});
