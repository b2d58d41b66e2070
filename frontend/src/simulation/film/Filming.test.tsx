// @vitest-environment jsdom
import { fireEvent, screen } from "@testing-library/react";
import { useState } from "react";
import { beforeEach, expect, test, vi } from "vitest";
import { show, testsPages } from "@/testing/page";
import { Filming } from "./Filming";

testsPages();
beforeEach(() => {
  vi.stubGlobal("MediaRecorder", { isTypeSupported: () => true });
});

const PLAYER = { t_s: 0, playing: false, seek() {}, setSpeed() {}, setPlaying() {} };

function Screen() {
  const [opened, open] = useState(true);
  return (
    <>
      <button onClick={() => open(true)}>Open</button>
      <Filming rehearsal="7" duration_s={60} player={PLAYER} opened={opened} onClose={() => open(false)} />
    </>
  );
}

test("a film that cannot begin leaves its dialog open with the reason, until it is closed", () => {
  show(<Screen />); // with no 3D view
  fireEvent.click(screen.getByRole("button", { name: "Film it" }));
  expect(screen.getByRole("alert").textContent).toContain("3D");
  fireEvent.click(screen.getByRole("button", { name: "Cancel" }));
  expect(screen.queryByRole("dialog")).toBeNull();
  fireEvent.click(screen.getByText("Open"));
  expect(screen.getByRole("dialog")).toBeTruthy();
  expect(screen.queryByRole("alert")).toBeNull();
});
