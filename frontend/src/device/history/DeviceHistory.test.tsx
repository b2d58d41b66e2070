// @vitest-environment jsdom
import { screen, waitFor } from "@testing-library/react";
import { expect, test, vi } from "vitest";
import { show, testsPages } from "@/testing/page";
import { DeviceHistory } from "./DeviceHistory";

testsPages();

test("as many lines of a device's history are shown as there is room for", async () => {
  const lines = Array.from({ length: 300 }, () => ({
    at: "2026-11-30T08:00:00Z",
    kind: "online",
    text: "Came.",
    code: "",
    args: {},
    by: null,
    changes: [],
  }));
  vi.stubGlobal("fetch", (path: string) => {
    const limit = Number(new URL(path, "http://vipo").searchParams.get("limit") ?? 50);
    return Promise.resolve(Response.json(lines.slice(0, limit)));
  });
  show(
    <>
      <DeviceHistory slug="hall" device="mixer" most={6} />
      <DeviceHistory slug="hall" device="mixer" most={200} />
    </>,
  );
  await waitFor(() => expect(screen.getAllByText("Came.")).toHaveLength(206));
});
