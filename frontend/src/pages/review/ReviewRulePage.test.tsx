// @vitest-environment jsdom
import { act, fireEvent, screen } from "@testing-library/react";
import { beforeEach, expect, test, vi } from "vitest";
import { showAt, testsPages } from "@/testing/page";
import { ReviewRulePage } from "./ReviewRulePage";

/** A line to a server that the test plays. */
class Line {
  static all: Line[] = [];
  onmessage: ((event: { data: string }) => void) | null = null;
  constructor() {
    Line.all.push(this);
  }
  say(message: unknown) {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
  close() {}
}

const STOP = { active: false, by: null, at: null };
const SITE = { slug: "", name: "Hall", role: "admin", machines: 0, robots: 0, online: 0, pending: 0, stop: STOP };
let rule: { approvals: number; least_role: string };

function answer(path: string, init: RequestInit) {
  if (path.endsWith("/review-rule") && init.method === "PUT")
    rule = { ...rule, ...(JSON.parse(init.body as string) as Partial<typeof rule>) };
  if (path.endsWith("/review-rule")) return rule;
  if (path === "/api/me") return { csrf: "", demo_accounts: [], user: { id: 1, name: "Anna" } };
  return /^.api.sites.[^/]+$/.test(path) ? SITE : [];
}

testsPages();
beforeEach(() => {
  vi.stubGlobal("WebSocket", Line);
  vi.stubGlobal("fetch", (path: string, init: RequestInit) => Promise.resolve(Response.json(answer(path, init))));
  [Line.all, rule] = [[], { approvals: 0, least_role: "operator" }];
});

async function openForm(slug: string) {
  showAt(`/sites/${slug}/review`, [{ path: "/sites/:slug/review", element: <ReviewRulePage /> }]);
  await expect.poll(fields).toHaveLength(2);
}

/** Not by their role, which is worked out for all that the page holds. */
const fields = () => [...document.querySelectorAll("select")];
const values = () => fields().map(({ value }) => value);
const choose = (field: number, value: string) =>
  fireEvent.change(fields()[field] as HTMLElement, { target: { value } });
const save = () => fireEvent.click(screen.getByText("Save"));

/** Another admin sets the rule; the news of it come. */
function setByOther(other: typeof rule) {
  rule = other;
  act(() => Line.all.at(-1)?.say({ type: "review" }));
}

test("what another admin sets meanwhile is shown beside what was touched here", async () => {
  await openForm("hall");
  choose(1, "author");
  setByOther({ approvals: 2, least_role: "operator" });
  await expect.poll(values).toEqual(["2", "author"]);
});

test("saving one field does not turn back the other, and what was saved gives way to what is set later", async () => {
  await openForm("shed");
  rule = { approvals: 2, least_role: "operator" }; // by another admin; the news of it are on their way
  choose(1, "author");
  save();
  await expect.poll(() => rule).toEqual({ approvals: 2, least_role: "author" });
  await expect.poll(values).toEqual(["2", "author"]);
  setByOther({ approvals: 1, least_role: "admin" });
  await expect.poll(values).toEqual(["1", "admin"]);
});
