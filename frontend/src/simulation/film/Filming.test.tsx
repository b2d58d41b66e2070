// @vitest-environment jsdom
import { MantineProvider } from "@mantine/core";
import { cleanup, fireEvent, render, screen } from "@testing-library/react";
import { useState } from "react";
import { afterEach, beforeAll, expect, test, vi } from "vitest";
import { loadScreenTexts, startI18n } from "@/i18n";
import { Filming } from "./Filming";

vi.hoisted(() => {
  Object.assign(globalThis, {
    matchMedia: () => ({ matches: false, addEventListener() {}, removeEventListener() {} }),
    MediaRecorder: { isTypeSupported: () => true },
    ResizeObserver: class {
      observe() {}
      unobserve() {}
      disconnect() {}
    },
  });
});
beforeAll(async () => {
  await startI18n();
  await loadScreenTexts();
});
afterEach(cleanup);

const PLAYER = { t_s: 0, playing: false, seek() {}, setSpeed() {}, setPlaying() {} };

function Screen() {
  const [opened, open] = useState(true);
  return (
    <MantineProvider env="test">
      <button onClick={() => open(true)}>Open</button>
      <Filming rehearsal="7" duration_s={60} player={PLAYER} opened={opened} onClose={() => open(false)} />
    </MantineProvider>
  );
}

test("a film that cannot begin leaves its dialog open with the reason, until it is closed", () => {
  render(<Screen />); // with no 3D view
  fireEvent.click(screen.getByRole("button", { name: "Film it" }));
  expect(screen.getByRole("alert").textContent).toContain("3D");
  fireEvent.click(screen.getByRole("button", { name: "Cancel" }));
  expect(screen.queryByRole("dialog")).toBeNull();
  fireEvent.click(screen.getByText("Open"));
  expect(screen.getByRole("dialog")).toBeTruthy();
  expect(screen.queryByRole("alert")).toBeNull();
});
