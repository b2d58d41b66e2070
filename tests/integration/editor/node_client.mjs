// Plain y-websocket clients in Node, told what to do by one JSON object a line; every command is answered by a line.
import { createInterface } from "node:readline";
import { isSaved, openClient, sorted, Y } from "./yjs_client.mjs";

const config = JSON.parse(process.argv[3]);
const clients = new Map();
const problems = [];
console.error = (...words) => problems.push(words.join(" "));
console.warn = console.error;

function open({ name, session, port }) {
  clients.set(name, openClient({ program: config.program, session, port }));
}

const until = async (what, check) => {
  const end = Date.now() + 60000;
  while (!check()) {
    if (Date.now() > end) throw new Error(`gave up waiting: ${what}`);
    await new Promise((done) => setTimeout(done, 10));
  }
};

function addStep(client, { id, kind, x, y, parent, params }) {
  client.doc.transact(() => {
    const step = new Y.Map();
    step.set("kind", kind ?? "wait");
    step.set("place", [parent ?? "program", "body", id]);
    step.set("pos", [x ?? 1, y ?? 2.5]);
    step.set("params", new Y.Map(Object.entries(params ?? { duration: 5 })));
    client.doc.getMap("steps").set(id, step);
  });
}

const commands = {
  async open(command) {
    open(command);
    const client = clients.get(command.name);
    if (command.wait !== false) await until("sync", () => client.provider.synced || client.closed);
    return { closed: client.closed };
  },
  add: (command) => addStep(clients.get(command.name), command),
  move: ({ name, id, pos }) => clients.get(name).doc.getMap("steps").get(id).set("pos", pos),
  remove: ({ name, id }) => clients.get(name).doc.getMap("steps").delete(id),
  function({ name, id, label, calls }) {
    const client = clients.get(name);
    client.doc.getMap("functions").set(id, { name: label, parameters: [] });
    addStep(client, { id: `${id}-wait`, parent: id });
    if (calls) addStep(client, { id: `${id}-call`, kind: "call", parent: id, params: { function: calls, args: {} } });
  },
  async storm({ steps }) {
    const all = [...clients.values()];
    for (let round = 0; round < steps; round += 1) {
      all.forEach((client, index) => {
        const map = client.doc.getMap("steps");
        const keys = [...map.keys()].filter((key) => key.startsWith("s")).sort(); // others are not the storm's
        const key = keys[(round * 7 + index) % Math.max(1, keys.length)];
        if (round % 5 === 3 && key) map.delete(key);
        else if (round % 2 && key) map.get(key).set("pos", [round, index]);
        else addStep(client, { id: `s${index}-${round}`, x: round, y: index });
      });
      await new Promise((done) => setTimeout(done, 5));
    }
  },
  fill({ name, bytes }) {
    clients.get(name).doc.getMap("parameters").set("big", "x".repeat(bytes));
  },
  async saved({ name }) {
    const client = clients.get(name);
    await until("saved", () => isSaved(client));
  },
  async converged() {
    const texts = () => new Set([...clients.values()].map((c) => JSON.stringify(sorted(c.doc.getMap("steps").toJSON()))));
    await until("all alike", () => [...clients.values()].every((c) => c.provider.synced) && texts().size === 1);
  },
  cut: ({ name }) => clients.get(name).provider.ws?.terminate(),
  disconnect: ({ name }) => clients.get(name).provider.disconnect(),
  async connect({ name }) {
    clients.get(name).provider.connect();
    await until("sync", () => clients.get(name).provider.synced);
  },
  async closed({ name }) {
    await until("closed", () => clients.get(name).closed);
    return { closed: clients.get(name).closed };
  },
  closed_for_good: ({ name }) => ({ closed: clients.get(name).closed }),
  show({ name, state }) {
    clients.get(name).provider.awareness.setLocalState(state);
  },
  async seen({ name, count }) {
    const { awareness } = clients.get(name).provider;
    await until("others", () => awareness.getStates().size === count);
    return { states: [...awareness.getStates().values()].map((state) => state.user?.name ?? null).sort() };
  },
  snapshot: ({ name }) => ({ snapshot: Buffer.from(Y.encodeSnapshot(Y.snapshot(clients.get(name).doc))).toString("base64") }),
  acknowledged: ({ name }) => {
    const { savedAt, refused, made, opened } = clients.get(name);
    return { savedAt, refused, made, opened };
  },
  steps: ({ name }) => ({ steps: clients.get(name).doc.getMap("steps").toJSON() }),
  destroy({ name }) {
    clients.get(name).provider.destroy();
    clients.delete(name);
  },
  problems: () => ({ problems }),
};

for await (const line of createInterface({ input: process.stdin })) {
  const command = JSON.parse(line);
  try {
    const answer = (await commands[command.do](command)) ?? {};
    process.stdout.write(JSON.stringify({ ok: true, ...answer }) + "\n");
  } catch (error) {
    process.stdout.write(JSON.stringify({ ok: false, error: String(error), problems }) + "\n");
  }
}
process.exit(0);
