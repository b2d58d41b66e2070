// @vitest-environment jsdom
import { notifications, Notifications } from "@mantine/notifications";
import { act, fireEvent, screen, waitFor } from "@testing-library/react";
import { useState } from "react";
import { afterEach, expect, test, vi } from "vitest";
import type { SiteMap } from "@/api/types";
import { show, testsPages } from "@/testing/page";
import { ObstacleHandles } from "./ObstacleHandles";
import { useObstacles } from "./useObstacles";

testsPages();
afterEach(() => notifications.clean());

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
  const waiting: { asked: string; answer: (status: number) => void }[] = [];
  vi.stubGlobal("fetch", (path: string, { method, body }: RequestInit) => {
    const asked = `${method} ${path.split("/").at(-1)} ${body as string}`;
    return new Promise((done) => waiting.push({ asked, answer: (status) => done(new Response("{}", { status })) }));
  });
  show(
    <>
      <Notifications />
      <Floor />
    </>,
  );
  return waiting;
}

function moved(name: RegExp) {
  const handle = screen.getByRole("button", { name });
  for (const key of ["ArrowRight", "Enter"]) fireEvent.keyDown(handle, { key });
}

test("an obstacle that is moved while another is being sent is sent after it", async () => {
  const waiting = begun();
  moved(/50.cm/);
  moved(/30.cm/);
  await waitFor(() => expect(waiting).toHaveLength(1));
  await act(() => Promise.resolve(waiting[0]?.answer(200)));
  await waitFor(() => expect(waiting).toHaveLength(2));
  expect(waiting.map(({ asked }) => asked)).toEqual([
    'PUT 1 {"x":2.1,"y":2,"size_m":0.5}',
    'PUT 2 {"x":6.1,"y":6,"size_m":0.3}',
  ]);
});

test("a move that is refused is told also where obstacles are not changed any more", async () => {
  const waiting = begun();
  moved(/50.cm/);
  await waitFor(() => expect(waiting).toHaveLength(1));
  fireEvent.click(screen.getByText("Done"));
  await act(() => Promise.resolve(waiting[0]?.answer(422)));
  expect(await screen.findByRole("alert")).toBeTruthy();
});

test("an obstacle whose move is refused goes back, and that is told", async () => {
  const waiting = begun();
  moved(/50.cm/);
  expect(screen.getByRole("button", { name: /2\.10/ })).toBeTruthy();
  await waitFor(() => expect(waiting).toHaveLength(1));
  await act(() => Promise.resolve(waiting[0]?.answer(422)));
  await waitFor(() => expect(screen.queryByRole("button", { name: /2\.10/ })).toBeNull());
  expect(await screen.findByRole("alert")).toBeTruthy();
});
