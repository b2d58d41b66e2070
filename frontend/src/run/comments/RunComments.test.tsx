// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider } from "@tanstack/react-query";
import { act, cleanup, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { MemoryRouter } from "react-router-dom";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import type { Run, Site } from "@/api/types";
import { loadScreenTexts, startI18n } from "@/i18n";
import { RunComments } from "./RunComments";
import { useRunComments } from "./useRunComments";

beforeEach(async () => {
  const media = { matches: false, addEventListener: () => undefined, removeEventListener: () => undefined };
  vi.stubGlobal("matchMedia", () => media);
  vi.stubGlobal("ResizeObserver", class { observe() {} unobserve() {} disconnect() {} }); // prettier-ignore
  Object.defineProperty(document, "fonts", { configurable: true, value: media });
  Element.prototype.scrollIntoView = () => undefined;
  await startI18n();
  await loadScreenTexts();
});
afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

const RUN = { id: "r", program: { id: "p", name: "Tour" }, started_at: "2026-11-30T08:00:00Z" } as Run;

const SITE = { slug: "hall", role: "author" } as Site;

function Page() {
  const comments = useRunComments(RUN, SITE);
  return (
    <>
      <button type="button" onClick={() => comments.setWriting({ t_s: 20, label: "" })}>
        Later
      </button>
      <RunComments
        run={RUN}
        role={SITE.role}
        comments={comments}
        about={{ t_s: 10, label: "" }}
        tell={() => undefined}
        onMoment={() => undefined}
      />
    </>
  );
}

test("a form about another moment stays open when what was sent before has arrived", async () => {
  const sent: (() => void)[] = [];
  vi.stubGlobal("fetch", (_: string, { method }: RequestInit) =>
    method === "POST"
      ? new Promise((resolve) => sent.push(() => resolve(Response.json({ id: "t" }))))
      : Promise.resolve(Response.json([])),
  );
  const queries = makeQueryClient();
  queries.setQueryData(keys.me, { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna", initials: "A" } });
  queries.setQueryData(keys.peopleToMention("p"), []);
  render(
    <QueryClientProvider client={queries}>
      <MantineProvider env="test">
        <MemoryRouter>
          <Page />
        </MemoryRouter>
      </MantineProvider>
    </QueryClientProvider>,
  );
  fireEvent.click(screen.getByRole("button", { name: "Comment on 0:10" }));
  fireEvent.change(screen.getByLabelText("Comment on 0:10"), { target: { value: "Why so slow?" } });
  fireEvent.submit(screen.getByLabelText<HTMLTextAreaElement>("Comment on 0:10").form as HTMLFormElement);
  await waitFor(() => expect(sent).toHaveLength(1));
  fireEvent.click(screen.getByText("Later"));
  act(() => sent[0]?.());
  await waitFor(() => expect(screen.getByLabelText<HTMLTextAreaElement>("Comment on 0:20").value).toBe(""));
  await act(async () => {}); // what comes of the answer is over
  expect(screen.getByLabelText("Comment on 0:20")).toBeDefined();
});
