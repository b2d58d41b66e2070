// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider } from "@tanstack/react-query";
import { fireEvent, render, screen } from "@testing-library/react";
import { beforeEach, expect, test, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import type { Retention } from "@/api/types";
import { testsPages } from "@/testing/page";
import { Times } from "./Times";

type Days = Record<"runs" | "rehearsals" | "calls", number | null>;
let days: Days;

const retentionOf = (chosen: Days) =>
  ({
    keeping: Object.entries(chosen).map(([kind, each]) => ({ kind, chosen: each, days: 9, server: 9 })),
  }) as Retention;

testsPages();
beforeEach(() => {
  vi.stubGlobal("fetch", (_: string, init: RequestInit) => {
    if (init.method === "PUT") days = { ...days, ...(JSON.parse(init.body as string) as Partial<Days>) };
    return Promise.resolve(Response.json(retentionOf(days)));
  });
  days = { runs: 30, rehearsals: null, calls: 7 };
});

const page = (queries = makeQueryClient()) => (
  <QueryClientProvider client={queries}>
    <MantineProvider env="test">
      <Times slug="hall" retention={retentionOf(days)} />
    </MantineProvider>
  </QueryClientProvider>
);
const fields = () => screen.getAllByRole<HTMLInputElement>("textbox");
const type = (field: number, value: string) => fireEvent.change(fields()[field] as HTMLElement, { target: { value } });

test("saving one time does not turn back another that somebody has set meanwhile", async () => {
  render(page());
  days = { ...days, calls: 0 };
  type(0, "60");
  fireEvent.click(screen.getByRole("button", { name: "Save" }));
  await expect.poll(() => days).toEqual({ runs: 60, rehearsals: null, calls: 0 });
});

test("a time that somebody sets meanwhile is shown beside the one that is typed, and an emptied one is the server's", async () => {
  const view = render(page());
  type(0, "");
  days = { ...days, rehearsals: 5 };
  view.rerender(page());
  expect(fields().map(({ value }) => value)).toEqual(["", "5", "7"]);
  fireEvent.click(screen.getByRole("button", { name: "Save" }));
  await expect.poll(() => days).toEqual({ runs: null, rehearsals: 5, calls: 7 });
});

test("what is no number of days is not saved", () => {
  render(page());
  type(2, "soon");
  expect(screen.getByRole("button", { name: "Save" }).hasAttribute("disabled")).toBe(true);
});
