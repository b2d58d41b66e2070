// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test } from "vitest";
import type { Program } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { SaveVersion } from "./SaveVersion";

testsPages();

const press = (words: string) => fireEvent.click(screen.getByText(words, { selector: "button *" }));

test("a version that is refused after its form was closed is told, and the next form knows nothing of it", async () => {
  const { nth } = slowServer();
  showWithCorner(<SaveVersion program={{ id: "p" } as Program} />);
  press("Save version");
  await screen.findByLabelText("Name");
  press("Save");
  const asked = await nth(1);
  press("Cancel");
  await waitFor(() => expect(screen.queryByLabelText("Name")).toBeNull());
  await asked.answer(409);
  expect(await screen.findByText("No.")).toBeTruthy();
  press("Save version");
  await screen.findByLabelText("Name");
  expect(screen.getAllByText("No.")).toHaveLength(1);
});
