import { act, waitFor } from "@testing-library/react";
import { expect, vi } from "vitest";

/** What the server was asked to do, and its answer when the test gives it. */
interface Waiting {
  readonly asked: string;
  readonly sent: unknown;
  readonly answer: (status: number, body?: unknown) => Promise<void>;
}

/**
 * A server that carries out nothing before it is told what comes of it, and knows nothing but these answers by the end
 * of their address, and empty lists.
 */
export function slowServer(known: Readonly<Record<string, unknown>> = {}) {
  const waiting: Waiting[] = [];
  const told = (path: string) => Object.entries(known).find(([end]) => path.endsWith(end))?.[1] ?? [];
  vi.stubGlobal("fetch", (path: string, { method = "GET", body }: RequestInit = {}) => {
    if (method === "GET") return Promise.resolve(Response.json(told(path)));
    return new Promise<Response>((done) => {
      const answer = (status: number, says: unknown = { code: "refused", detail: "No." }) =>
        act(() => Promise.resolve(done(Response.json(says, { status }))));
      const asked = `${method} ${path.replace("/api/sites/hall", "")}`;
      waiting.push({ asked, sent: typeof body === "string" ? JSON.parse(body) : null, answer });
    });
  });
  /** The one of this number, from 1, once it is asked; nothing more is asked by then. */
  const nth = async (number: number): Promise<Waiting> => {
    await waitFor(() => expect(waiting).toHaveLength(number));
    return waiting[number - 1] as Waiting;
  };
  return { waiting, nth };
}
