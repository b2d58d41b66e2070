// People who draw, delete and undo at two web processes while one of them is killed. Each remembers, for every step of
// its own, what it was after which of its changes, so that a judge can say what must be there. One command a line.
import { createInterface } from "node:readline";
import { isSaved, openClient, sorted, Y } from "../yjs_client.mjs";

const people = new Map();
console.error = console.warn = () => {};

function open({ name, program, session, port }) {
  const client = openClient({ program, session, port });
  const steps = client.doc.getMap("steps");
  const me = { ...client, client, steps, program, history: {}, round: 0, drawing: false };
  me.undo = new Y.UndoManager(steps, { trackedOrigins: new Set([me]), captureTimeout: 0 });
  steps.observeDeep((events, transaction) => {
    if (transaction.origin !== me && transaction.origin !== me.undo) return;
    const ids = new Set(events.flatMap((event) => (event.path.length ? [event.path[0]] : [...event.changes.keys.keys()])));
    for (const id of ids) (me.history[id] ??= []).push([client.made + 1, sorted(steps.get(id)?.toJSON() ?? null)]);
  });
  people.set(name, me);
}

/** One random change of a step that is this person's own. */
function change(me, name) {
  const mine = [...me.steps.keys()].filter((id) => id.startsWith(`${name}-`));
  const any = mine[Math.floor(Math.random() * mine.length)];
  const dice = Math.random();
  if (any && dice < 0.25) me.client.doc.transact(() => me.steps.delete(any), me);
  else if (any && dice < 0.5) me.client.doc.transact(() => me.steps.get(any).set("pos", [me.round, 1]), me);
  else if (dice < 0.65) me.undo.undo();
  else if (dice < 0.7) me.undo.redo();
  else
    me.client.doc.transact(() => {
      const step = new Y.Map([["kind", "wait"], ["pos", [me.round, 0]], ["params", new Y.Map([["duration", 5]])]]);
      me.steps.set(`${name}-${me.round}`, step);
    }, me);
  me.round += 1;
}

async function draw(me, name, everyMs) {
  while (me.drawing) {
    change(me, name);
    await new Promise((done) => setTimeout(done, Math.random() * 2 * everyMs));
  }
}

const until = async (what, check) => {
  const end = Date.now() + 120_000;
  while (!check()) {
    if (Date.now() > end) throw new Error(`gave up waiting: ${what} ${unsaved()}`);
    await new Promise((done) => setTimeout(done, 10));
  }
};

const unsaved = () =>
  JSON.stringify(
    [...people].filter(([, me]) => !isSaved(me.client)).map(([name, { client }]) => {
      const { made, savedAt, frames, saved, marks, closed, provider } = client;
      return { name, made, savedAt, frames, saved, marks: marks.slice(-3), closed, synced: provider.synced };
    }),
  );

const commands = {
  async open(command) {
    open(command);
    await until("sync", () => people.get(command.name).client.provider.synced);
  },
  draw({ everyMs }) {
    for (const [name, me] of people) {
      me.drawing = true;
      void draw(me, name, everyMs);
    }
  },
  stop() {
    for (const me of people.values()) me.drawing = false;
  },
  /** What of each person's steps was called saved: the change that it was called saved at, and the steps' histories. */
  acknowledged: () => ({
    people: [...people].map(([name, me]) => ({ name, program: me.program, savedAt: me.client.savedAt, history: me.history })),
  }),
  async settled() {
    await until("saved", () => [...people.values()].every((me) => isSaved(me.client)));
    const texts = () => {
      const of = new Map();
      for (const me of people.values())
        of.set(me.program, (of.get(me.program) ?? new Set()).add(JSON.stringify(sorted(me.steps.toJSON()))));
      return [...of.values()];
    };
    await until("alike", () => texts().every((each) => each.size === 1));
    return { steps: Object.fromEntries([...people.values()].map((me) => [me.program, sorted(me.steps.toJSON())])) };
  },
  leave({ names }) {
    for (const name of names) {
      people.get(name).client.provider.destroy();
      people.delete(name);
    }
  },
};

for await (const line of createInterface({ input: process.stdin })) {
  const command = JSON.parse(line);
  try {
    const answer = (await commands[command.do](command)) ?? {};
    process.stdout.write(JSON.stringify({ ok: true, ...answer }) + "\n");
  } catch (error) {
    process.stdout.write(JSON.stringify({ ok: false, error: String(error) }) + "\n");
  }
}
process.exit(0);
