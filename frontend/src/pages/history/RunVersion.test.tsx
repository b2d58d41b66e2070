// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import type { Program, Site, Version } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { RunVersion } from "./RunVersion";

testsPages();

const DOCUMENT = {
  steps: {},
  roles: {},
  parameters: { p: { name: "Boxes", type: "number", default: null, unit: "" } },
};

/** A server with one version, which has so many errors at its site; what is to be run is written down. */
function serve(errors: number) {
  const runs: unknown[] = [];
  const side = { version: null, document: DOCUMENT, compiled: null, problem: "", errors };
  const answers: [string, unknown][] = [
    ["/programs/task/versions/2", { number: 2, document: DOCUMENT }],
    ["/programs/task/comparison?old=2&new=2", { old: side, new: side, difference: null }],
    ["/sites/hall/devices", []],
  ];
  vi.stubGlobal("fetch", (address: string, asked: RequestInit = {}) => {
    if (asked.method === "POST" && address === "/api/programs/task/runs") {
      runs.push(JSON.parse(asked.body as string));
      return Promise.resolve(new Response(JSON.stringify({ id: "r" })));
    }
    const answer = answers.find(([path]) => address === `/api${path}`);
    return Promise.resolve(answer ? new Response(JSON.stringify(answer[1])) : new Response("{}", { status: 404 }));
  });
  return runs;
}

function open() {
  const program = { id: "task", name: "Paint order" } as Program;
  const site = { slug: "hall", simulated: true, role: "operator", stop: { active: false } } as Site;
  const version = { number: 2 } as Version;
  show(<RunVersion {...{ program, site, version }} onClose={() => undefined} />);
}

const runIt = () => screen.findByRole<HTMLButtonElement>("button", { name: "Run" });

test("a version whose parameter has no default asks for its value, and is run with it", async () => {
  const runs = serve(0);
  open();
  expect((await runIt()).disabled).toBe(true);
  expect(screen.getByText(/^v2 is run as it was/)).toBeTruthy();
  expect(screen.getByLabelText("Begin not before")).toBeTruthy();
  expect(await screen.findByText("All checks passed")).toBeTruthy();
  fireEvent.change(screen.getByLabelText("Boxes"), { target: { value: "3" } });
  fireEvent.click(await runIt());
  await waitFor(() => expect(runs).toHaveLength(1));
  expect(runs[0]).toMatchObject({ version: 2, parameters: { Boxes: 3 } });
});

test("what speaks against a version today is told before it is run", async () => {
  serve(2);
  open();
  expect(await screen.findByText("2 errors to fix first")).toBeTruthy();
  fireEvent.change(screen.getByLabelText("Boxes"), { target: { value: "3" } });
  expect((await runIt()).disabled).toBe(true);
});
