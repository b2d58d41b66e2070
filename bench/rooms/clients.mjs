// Plain y-websocket clients that each move a step of their own ten times a second; prints when the others saw it.
import { createRequire } from "node:module";

const require = createRequire(process.argv[2] + "/package.json");
const Y = require("yjs");
const { WebsocketProvider } = require("y-websocket");
const WebSocket = require("ws");
const { program, port, sessions, perSecond, seconds } = JSON.parse(process.argv[3]);
const rest = (ms) => new Promise((done) => setTimeout(done, ms));
const delays = [];

const clients = sessions.map((session) => {
  class Socket extends WebSocket {
    constructor(url, protocols) {
      super(url, protocols, { headers: { Cookie: `sessionid=${session}`, Origin: `http://127.0.0.1:${port}` } });
    }
  }
  const doc = new Y.Doc();
  const provider = new WebsocketProvider(`ws://127.0.0.1:${port}/ws/program`, program, doc, {
    WebSocketPolyfill: Socket,
    disableBc: true,
  });
  return { doc, provider, sent: [] };
});

async function until(check) {
  for (const end = Date.now() + 15000; !check(); await rest(10)) if (Date.now() > end) return false;
  return true;
}

/** An update has arrived when the receiver's clock of its sender has reached what the sender's was after it. */
function watch(receiver, sender) {
  let next = 0;
  receiver.doc.on("update", () => {
    const reached = Y.getState(receiver.doc.store, sender.doc.clientID);
    for (; next < sender.sent.length && sender.sent[next].clock <= reached; next += 1) {
      delays.push(performance.now() - sender.sent[next].at);
    }
  });
}

function edit(client, index, round) {
  const steps = client.doc.getMap("steps");
  const at = performance.now();
  const entry = { at, clock: Infinity };
  client.sent.push(entry);
  client.doc.transact(() => {
    if (!steps.has(`s${index}`)) {
      const step = new Y.Map();
      step.set("kind", "wait");
      step.set("place", ["program", "body", `V${index}V`]);
      step.set("params", new Y.Map([["seconds", 5]]));
      steps.set(`s${index}`, step);
    }
    steps.get(`s${index}`).set("pos", [round, index]);
  });
  entry.clock = Y.getState(client.doc.store, client.doc.clientID);
}

if (!(await until(() => clients.every((client) => client.provider.synced)))) throw new Error("not all could join");
for (const sender of clients) for (const receiver of clients) if (sender !== receiver) watch(receiver, sender);
await Promise.all(
  clients.map(async (client, index) => {
    const began = performance.now() + (index * 1000) / perSecond / clients.length;
    for (let round = 0; round < perSecond * seconds; round += 1) {
      await rest(Math.max(0, began + (round * 1000) / perSecond - performance.now()));
      edit(client, index, round);
    }
  }),
);
const wanted = clients.length * (clients.length - 1) * perSecond * seconds;
await until(() => delays.length >= wanted);
const texts = clients.map(({ doc }) => JSON.stringify(Object.entries(doc.getMap("steps").toJSON()).sort()));
const alike = texts.filter((text) => text === texts[0]).length;
process.stdout.write(JSON.stringify({ delays_ms: delays, alike }), () => process.exit(0));
