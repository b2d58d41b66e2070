// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { fireEvent, render, screen } from "@testing-library/react";
import { expect, test } from "vitest";
import type { CellMap } from "@/map/floor/rosFiles";
import { testsPages } from "@/testing/page";
import { drawn } from "./cells/drawn";
import { FIRST_SETTINGS } from "./tools";
import { ToolPanel } from "./ToolPanel";

testsPages();

const LONG: CellMap = { ...drawn("#"), width: 4096, height: 300, cells: new Uint8Array(4096 * 300) };

test("who asks for a turn after which the map would be too large is told so", () => {
  const asked: CellMap[] = [];
  const go = (map: CellMap) => asked.push(map);
  render(
    <MantineProvider>
      <ToolPanel map={LONG} settings={FIRST_SETTINGS} set={() => {}} change={go} changeLie={go} measured={[]} />
    </MantineProvider>,
  );
  const turn = screen.getByRole("button", { name: "Turn" });
  const angle = screen.getByRole("textbox", { name: "Degrees" });
  fireEvent.change(angle, { target: { value: "5" } });
  expect(screen.getByText(/more than 4,096 cells on a side/).getAttribute("role")).toBe("status");
  expect((turn as HTMLButtonElement).disabled).toBe(true);
  fireEvent.change(angle, { target: { value: "90" } });
  expect(screen.queryByText(/more than 4,096 cells/)).toBeNull();
  fireEvent.click(turn);
  expect(asked.map(({ width, height }) => [width, height])).toEqual([[300, 4096]]);
});
