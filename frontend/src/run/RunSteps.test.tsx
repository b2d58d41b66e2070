// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeAll, expect, test, vi } from "vitest";
import type { RunEvent } from "@/api/types";
import { startI18n } from "@/i18n";
import type { JournalLines } from "./journalLines";
import { Journal } from "./RunSteps";

beforeAll(() => startI18n());
afterEach(cleanup);

function journalOf(to: number, from = 1, more: Partial<JournalLines> = {}) {
  const lines = Array.from({ length: to - from + 1 }, (_, at) => ({
    seq: from + at,
    t_s: at,
    kind: "notice",
    level: "info",
    step: "",
    device: "",
    code: "",
    text: `line ${from + at}`,
    args: {},
  }));
  const journal: JournalLines = {
    lines: lines as unknown as RunEvent[],
    older: from - 1,
    fetchOlder: () => undefined,
    isFetching: false,
    problem: null,
    ...more,
  };
  return (
    <MantineProvider env="test">
      <Journal journal={journal} numberOf={() => ""} nameOf={(id) => id} label="Journal" onWrite={null} />
    </MantineProvider>
  );
}

const lines = () => document.querySelectorAll("li");

test("of a long journal the newest lines are on the screen, and older ones at a press", () => {
  const { rerender } = render(journalOf(1200));
  expect(lines()).toHaveLength(500);
  expect(lines()[499]?.textContent).toContain("line 1200");
  fireEvent.click(screen.getByText("Show older lines (700)"));
  expect(lines()[0]?.textContent).toContain("line 201");
  rerender(journalOf(1203));
  expect([lines()[0]?.textContent, lines().length]).toEqual([expect.stringContaining("line 201"), 1003]);
  fireEvent.click(screen.getByText("Show older lines (200)"));
  expect(lines()).toHaveLength(1203);
  expect(screen.queryByText(/^Show older/)).toBeNull();
});

test("lines that are not here yet are asked for at a press, and stand above the others when they come", () => {
  const fetchOlder = vi.fn();
  const { rerender } = render(journalOf(20_000, 19_501, { fetchOlder }));
  expect(lines()).toHaveLength(500);
  expect(screen.queryByText(/^saved/)).toBeNull(); // how many of the older ones will be shown nobody knows
  fireEvent.click(screen.getByText("Show older lines (19500)"));
  expect(fetchOlder).toHaveBeenCalledOnce();
  rerender(journalOf(20_001, 19_001, { fetchOlder }));
  expect([lines()[0]?.textContent, lines().length]).toEqual([expect.stringContaining("line 19001"), 1001]);
  expect(screen.getByText("Show older lines (19000)")).toBeTruthy();
  expect(fetchOlder).toHaveBeenCalledOnce();
});

test("who looks at the newest lines keeps these alone on the screen, and is told why older ones did not come", () => {
  const { rerender } = render(journalOf(20_700, 19_501));
  expect(lines()[0]?.textContent).toContain("line 20201");
  rerender(journalOf(20_700, 19_501, { problem: "No answer." }));
  expect(screen.getByRole("alert").textContent).toBe("No answer.");
});
