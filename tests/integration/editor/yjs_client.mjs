// A plain y-websocket client that asks which of its messages are saved.
import { createRequire } from "node:module";

export const load = createRequire(process.argv[2] + "/package.json");
export const Y = load("yjs");
const { WebsocketProvider } = load("y-websocket");
const decoding = load("lib0/decoding");
const WebSocket = load("ws");
const SAVED = 100;

/** `made` counts its changes, `savedAt` says how many of them the server has called saved, `opened` its connections. */
export function openClient({ program, session, port }) {
  const client = { doc: new Y.Doc(), frames: 0, made: 0, saved: 0, savedAt: 0, refused: 0, opened: 0, closed: null, marks: [] };
  class Socket extends WebSocket {
    constructor(url, protocols) {
      super(url, protocols, { headers: { Cookie: `sessionid=${session}`, Origin: `http://127.0.0.1:${port}` } });
      client.frames = client.saved = 0;
      client.marks = [];
      this.on("open", () => super.send(Uint8Array.of(SAVED)));
      this.on("open", () => (client.opened += 1));
    }
    send(data) {
      super.send(data);
      const bytes = new Uint8Array(data);
      if (bytes[0] === 0 && bytes[1] > 0) client.marks.push([++client.frames, client.made]);
    }
  }
  client.doc.on("update", (_update, origin) => {
    if (origin !== client.provider) client.made += 1; // before the provider sends it
  });
  client.provider = new WebsocketProvider(`ws://127.0.0.1:${port}/ws/program`, program, client.doc, {
    WebSocketPolyfill: Socket, disableBc: true, maxBackoffTime: 300,
  });
  client.provider.on("closed", (event) => (client.closed = event.code));
  client.provider.messageHandlers[SAVED] = (_encoder, decoder) => {
    client.saved = decoding.readVarUint(decoder);
    client.refused = decoding.readVarUint(decoder);
    for (const [frame, made] of client.marks) if (frame <= client.saved) client.savedAt = Math.max(client.savedAt, made);
  };
  return client;
}

export const isSaved = (client) => client.provider.synced && client.marks.length > 0 && client.savedAt >= client.made;

export function sorted(value) {
  if (Array.isArray(value) || value === null || typeof value !== "object") return value;
  return Object.fromEntries(Object.keys(value).sort().map((key) => [key, sorted(value[key])]));
}
