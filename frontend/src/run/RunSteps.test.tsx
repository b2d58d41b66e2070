// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeAll, expect, test } from "vitest";
import type { RunEvent } from "@/api/types";
import { startI18n } from "@/i18n";
import { Journal } from "./RunSteps";

beforeAll(() => startI18n());
afterEach(cleanup);

function journalOf(lines: number) {
  const events = Array.from({ length: lines }, (_, at) => ({
    seq: at + 1,
    t_s: at,
    kind: "notice",
    level: "info",
    step: "",
    device: "",
    code: "",
    text: `line ${at + 1}`,
    args: {},
  }));
  return (
    <MantineProvider env="test">
      <Journal
        events={events as unknown as RunEvent[]}
        numberOf={() => ""}
        nameOf={(id) => id}
        label="Journal"
        onWrite={null}
      />
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
