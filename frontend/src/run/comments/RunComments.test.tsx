// @vitest-environment jsdom
import { act, fireEvent, screen, waitFor } from "@testing-library/react";
import { useLocation } from "react-router-dom";
import { expect, test, vi } from "vitest";
import { keys, makeQueryClient } from "@/api/queries";
import type { Run, Site } from "@/api/types";
import { show, showAt, testsPages } from "@/testing/page";
import { RunComments } from "./RunComments";
import { useRunComments } from "./useRunComments";

testsPages();

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
  show(<Page />, queries);
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

test("a thread that is opened and closed leaves what else the address says", async () => {
  vi.stubGlobal("fetch", () => Promise.resolve(Response.json([])));
  function Threads() {
    const { open } = useRunComments(RUN, SITE);
    return (
      <>
        <button onClick={() => open("t")}>Open</button>
        <button onClick={() => open(null)}>Close</button>
        <p>{useLocation().search}</p>
      </>
    );
  }
  showAt("/runs/r?view=3d", [{ path: "/runs/:id", element: <Threads /> }]);
  fireEvent.click(screen.getByText("Open"));
  expect(await screen.findByText("?view=3d&thread=t")).toBeTruthy();
  fireEvent.click(screen.getByText("Close"));
  expect(await screen.findByText("?view=3d")).toBeTruthy();
});
