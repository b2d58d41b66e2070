import type { AddressInfo } from "node:net";
import { afterEach, expect, test } from "vitest";
import { WebSocket as NodeSocket, WebSocketServer } from "ws";
import { WebsocketProvider } from "y-websocket";
import * as Y from "yjs";
import { MOMENT_MS, SavedChanges } from "./savedChanges";

const servers: WebSocketServer[] = [];
const providers: WebsocketProvider[] = [];
afterEach(() => {
  for (const provider of providers.splice(0)) provider.destroy();
  for (const server of servers.splice(0)) server.close();
});

/** A server that counts the messages with content, and calls saved what it is told to. */
function serve() {
  const server = new WebSocketServer({ port: 0 });
  servers.push(server);
  const seen = { asked: 0, connections: 0, frames: 0, socket: null as NodeSocket | null };
  server.on("connection", (socket) => {
    Object.assign(seen, { connections: seen.connections + 1, frames: 0, socket });
    socket.send(Uint8Array.of(0, 0, 1, 0)); // what do you have?
    socket.on("message", (data: Buffer) => {
      if (data[0] === 100) seen.asked += 1;
      if (data[0] === 0 && (data[1] ?? 0) > 0) seen.frames += 1;
      if (data[0] === 0 && data[1] === 0) socket.send(Uint8Array.of(0, 1, 2, 0, 0));
    });
  });
  const { port } = server.address() as AddressInfo;
  return {
    seen,
    url: `ws://127.0.0.1:${port}`,
    save: (n: number, not = 0) => seen.socket?.send(Uint8Array.of(100, n, not)),
  };
}

function join(url: string) {
  globalThis.WebSocket = NodeSocket as unknown as typeof WebSocket;
  const doc = new Y.Doc();
  const saved = new SavedChanges(() => {});
  doc.on("update", (_update, origin) => {
    if (origin === "me") saved.made();
  });
  const provider = new WebsocketProvider(url, "p", doc, { disableBc: true, WebSocketPolyfill: saved.Socket });
  providers.push(provider);
  saved.listen(provider.messageHandlers);
  const edit = (key: string) => doc.transact(() => doc.getMap("steps").set(key, 1), "me");
  return { doc, saved, provider, edit };
}

test("a change waits until the server calls its message saved", async () => {
  const server = serve();
  const { saved, provider, edit } = join(server.url);
  await expect.poll(() => provider.synced).toBe(true);
  await expect.poll(() => server.seen.frames).toBe(1);
  edit("a");
  edit("b");
  await expect.poll(() => server.seen.frames).toBe(3);
  expect(saved.waiting).toBe(2);
  server.save(2);
  await expect.poll(() => saved.waiting).toBe(1);
  server.save(3);
  await expect.poll(() => saved.waiting).toBe(0);
  expect(server.seen.asked).toBe(1);
});

test("what was made without a connection waits for the answer to the first question of the next one", async () => {
  const server = serve();
  const { saved, provider, edit } = join(server.url);
  await expect.poll(() => provider.synced).toBe(true);
  provider.disconnect();
  edit("a");
  expect(saved.waiting).toBe(1);
  provider.connect();
  await expect.poll(() => [server.seen.connections, server.seen.frames]).toEqual([2, 1]);
  expect(saved.waiting).toBe(1);
  server.save(1);
  await expect.poll(() => saved.waiting).toBe(0);
});

test("messages that were not taken are counted", async () => {
  const server = serve();
  const { saved, provider, edit } = join(server.url);
  await expect.poll(() => provider.synced).toBe(true);
  edit("a");
  server.save(1, 1);
  await expect.poll(() => saved.refused).toBe(1);
});

test("what pages before made waits for the first answer of the new connection", async () => {
  const server = serve();
  const { saved, provider } = join(server.url);
  saved.madeBefore(3);
  expect([saved.waiting, saved.late]).toEqual([3, true]);
  await expect.poll(() => provider.synced).toBe(true);
  await expect.poll(() => server.seen.frames).toBe(1);
  expect(saved.stored).toBe(0);
  server.save(1);
  await expect.poll(() => [saved.waiting, saved.stored, saved.late]).toEqual([0, 3, false]);
});

test("a change is late only when it has waited for a moment, and one that was not taken keeps waiting", async () => {
  const server = serve();
  const { saved, provider, edit } = join(server.url);
  await expect.poll(() => provider.synced).toBe(true);
  edit("a");
  expect(saved.late).toBe(false);
  await expect.poll(() => saved.late, { timeout: MOMENT_MS * 3 }).toBe(true);
  server.save(2, 1);
  await expect.poll(() => saved.refused).toBe(1);
  expect(saved.waiting).toBe(1);
});
