// @vitest-environment jsdom
import { fireEvent, screen, waitFor } from "@testing-library/react";
import { useState } from "react";
import { expect, test } from "vitest";
import type { SiteMap } from "@/api/types";
import { showWithCorner, testsPages } from "@/testing/page";
import { slowServer } from "@/testing/slowServer";
import { ObstacleHandles } from "./ObstacleHandles";
import { useObstacles } from "./useObstacles";

testsPages();

const MAP = {
  width: 100,
  height: 100,
  resolution_m: 0.1,
  origin: { x: 0, y: 0 },
  obstacles: [
    { id: 1, x: 2, y: 2, size_m: 0.5 },
    { id: 2, x: 6, y: 6, size_m: 0.3 },
  ],
} as unknown as SiteMap;

function Floor() {
  const [isOver, end] = useState(false);
  const editing = useObstacles("hall");
  return (
    <>
      <button onClick={() => end(true)}>Done</button>
      <svg>{isOver ? null : <ObstacleHandles slug="hall" map={MAP} editing={editing} />}</svg>
    </>
  );
}

/** Two obstacles, and a server that answers when it is told to. */
function begun() {
  const server = slowServer();
  showWithCorner(<Floor />);
  return server;
}

function moved(name: RegExp) {
  const handle = screen.getByRole("button", { name });
  for (const key of ["ArrowRight", "Enter"]) fireEvent.keyDown(handle, { key });
}

test("an obstacle that is moved while another is being sent is sent after it", async () => {
  const { nth, waiting } = begun();
  moved(/50.cm/);
  moved(/30.cm/);
  await nth(1);
  await waiting[0]?.answer(200);
  await nth(2);
  expect(waiting.map(({ asked, sent }) => [asked, sent])).toEqual([
    ["PUT /obstacles/1", { x: 2.1, y: 2, size_m: 0.5 }],
    ["PUT /obstacles/2", { x: 6.1, y: 6, size_m: 0.3 }],
  ]);
});

test("a move that is refused is told also where obstacles are not changed any more", async () => {
  const { nth, waiting } = begun();
  moved(/50.cm/);
  await nth(1);
  fireEvent.click(screen.getByText("Done"));
  await waiting[0]?.answer(422);
  expect(await screen.findByRole("alert")).toBeTruthy();
});

test("an obstacle whose move is refused goes back, and that is told", async () => {
  const { nth, waiting } = begun();
  moved(/50.cm/);
  expect(screen.getByRole("button", { name: /2\.10/ })).toBeTruthy();
  await nth(1);
  await waiting[0]?.answer(422);
  await waitFor(() => expect(screen.queryByRole("button", { name: /2\.10/ })).toBeNull());
  expect(await screen.findByRole("alert")).toBeTruthy();
});
