// Plain y-websocket clients, the same for every server. Prints "begin" and "end" around what is measured, then the result.
import { createRequire } from "node:module";

const require = createRequire(process.argv[2] + "/package.json");
const Y = require("yjs");
const { WebsocketProvider } = require("y-websocket");
const encoding = require("lib0/encoding");
const decoding = require("lib0/decoding");
const WebSocket = require("ws");
const config = JSON.parse(process.argv[3]);
process.setMaxListeners(0);
const SAVED = 100, COMPILED = 101;
const rest = (ms) => new Promise((done) => setTimeout(done, ms));
const say = (value) => new Promise((done) => process.stdout.write(JSON.stringify(value) + "\n", done));
const joined = (...parts) => new Uint8Array(Buffer.concat(parts));
const counted = (number) => encoding.encode((encoder) => encoding.writeVarUint(encoder, number));
const named = (name) => encoding.encode((encoder) => encoding.writeVarString(encoder, name));

async function until(what, check, limit = 60000) {
  for (const end = performance.now() + limit; !check(); await rest(2))
    if (performance.now() > end) throw new Error(`gave up waiting: ${what}`);
}

/** Hocuspocus puts the document's name before each message, and wants a token first; the rest is y-websocket's. */
function hocuspocus(Base, name) {
  return class extends Base {
    constructor(...args) {
      super(...args);
      this.on("open", () => super.send(joined(named(name), Uint8Array.of(2, 0), named("token"))));
    }
    set onmessage(act) {
      super.onmessage = (event) => {
        const data = new Uint8Array(event.data);
        const decoder = decoding.createDecoder(data);
        decoding.readVarString(decoder);
        const message = data.slice(decoder.pos);
        if (message[0] === 4) message[0] = 0; // its answers to a sync have a number of their own
        if ([0, 1, 3].includes(message[0])) act({ data: message.buffer });
      };
    }
    send(data) {
      super.send(joined(named(name), new Uint8Array(data)));
    }
  };
}

/** `asks` are frames to be sent at once; `seen` is called with each frame's kind and bytes. */
function open({ index = 0, room = config.room, asks = [], seen = () => {} }) {
  const port = config.ports[index % config.ports.length];
  const client = { doc: new Y.Doc(), sent: [], frames: 0, socket: null };
  class Socket extends WebSocket {
    constructor(url, protocols) {
      const headers = { Origin: `http://127.0.0.1:${port}`, Cookie: `sessionid=${config.sessions[index]}` };
      super(url, protocols, { headers: config.sessions.length ? headers : {}, perMessageDeflate: false });
      client.socket = this;
      this.on("open", () => asks.forEach((frame) => super.send(frame)));
      this.on("message", (data) => {
        const bytes = new Uint8Array(data);
        seen(bytes[0], bytes);
      });
    }
    send(data) {
      const bytes = new Uint8Array(data);
      if (bytes[0] === 0 && bytes[1] > 0) client.frames += 1;
      super.send(data);
    }
  }
  client.provider = new WebsocketProvider(`ws://127.0.0.1:${port}${config.path}`, room, client.doc, {
    WebSocketPolyfill: config.server === "hocuspocus" ? hocuspocus(Socket, room) : Socket, disableBc: true,
  });
  for (const kind of [SAVED, COMPILED]) client.provider.messageHandlers[kind] = () => {};
  return client;
}

/** An update has arrived when the receiver's clock of its sender has reached what the sender's was after it. */
function watch(receiver, senders, delays) {
  const next = new Map();
  receiver.doc.on("afterTransaction", ({ beforeState, afterState }) => {
    afterState.forEach((reached, id) => {
      const sender = beforeState.get(id) === reached ? undefined : senders.get(id);
      if (!sender || sender === receiver) return;
      let at = next.get(id) ?? 0;
      for (; at < sender.sent.length && sender.sent[at].clock <= reached; at += 1)
        delays.push(performance.now() - sender.sent[at].at);
      next.set(id, at);
    });
  });
}

function put(doc, id, parent, order, pos) {
  const step = new Y.Map();
  step.set("kind", "wait");
  step.set("place", [parent, "body", order]);
  step.set("pos", pos);
  step.set("params", new Y.Map([["duration", 5]]));
  doc.getMap("steps").set(id, step);
}

async function fill(count) {
  const client = open({});
  await until("the filler to join", () => client.provider.synced);
  for (let from = 0; from < count; from += 250) {
    client.doc.transact(() => {
      for (let n = from; n < Math.min(count, from + 250); n += 1) put(client.doc, `f${n}`, "program", `${String(n).padStart(5, "0")}V`, [n % 70, n / 70]);
    });
    await rest(60);
  }
  return client;
}

function edit(client, index, round) {
  const entry = { at: performance.now(), clock: Infinity };
  client.sent.push(entry);
  client.doc.transact(() => {
    const steps = client.doc.getMap("steps");
    if (!steps.has(`s${index}`)) put(client.doc, `s${index}`, "program", `V${index}V`, [0, 0]);
    steps.get(`s${index}`).set("pos", [round, index]);
  });
  entry.clock = Y.getState(client.doc.store, client.doc.clientID);
}

async function draw(writers) {
  const { perSecond, seconds } = config;
  await Promise.all(
    writers.map(async (client, index) => {
      const began = performance.now() + (index * 1000) / perSecond / writers.length;
      for (let round = 0; round < perSecond * seconds; round += 1) {
        await rest(Math.max(0, began + (round * 1000) / perSecond - performance.now()));
        edit(client, index, round);
      }
    }),
  );
}

/** `writers` draw and everybody is to see it, on top of `steps`; `pages`: each also has the site's socket and asks 101. */
async function together() {
  const filler = config.steps ? await fill(config.steps) : null;
  const told = { bytes: 0, site: 0 };
  const asks = config.pages ? [Uint8Array.of(COMPILED, 0)] : [];
  const seen = (kind, data) => (told.bytes += kind === COMPILED ? data.length : 0);
  const clients = [];
  for (let index = 0; index < config.writers + config.readers; index += 1) {
    clients.push(open({ index, asks, seen }));
    if (index % 10 === 9) await rest(40);
  }
  const all = () => clients.every(({ provider, doc }) => provider.synced && doc.getMap("steps").size >= (config.steps ?? 0));
  await until("all to join", all).catch((error) => console.error(String(error)));
  for (const page of config.pages ? clients : []) openSite(clients.indexOf(page), told);
  await rest(config.steps ? 4000 : 300);
  const writers = clients.slice(0, config.writers);
  const senders = new Map(writers.map((client) => [client.doc.clientID, client]));
  const delays = [];
  for (const receiver of clients) watch(receiver, senders, delays);
  const cpu = process.cpuUsage();
  told.bytes = told.site = 0;
  await say("begin");
  await draw(writers);
  const wanted = writers.length * (clients.length - 1) * config.perSecond * config.seconds;
  await until("all to arrive", () => delays.length >= wanted, 15000).catch(() => {});
  const spent = process.cpuUsage(cpu);
  await say("end");
  await rest(config.pages ? 1500 : 0);
  const content = ({ doc }) => JSON.stringify(Object.entries(doc.getMap("steps").toJSON()).sort(([a], [b]) => (a < b ? -1 : 1)));
  const first = content(clients[0]);
  const edits = writers.length * config.perSecond * config.seconds;
  return {
    delays_ms: delays, wanted, alike: clients.filter((client) => content(client) === first).length, clients: clients.length,
    clients_cpu_s: (spent.user + spent.system) / 1e6, joined: clients.filter(({ provider }) => provider.synced).length,
    page_bytes: (told.bytes + told.site) / clients.length / edits, site_bytes: told.site / clients.length / edits, filler: !!filler,
  };
}

function openSite(index, told) {
  const port = config.ports[index % config.ports.length];
  const headers = { Origin: `http://127.0.0.1:${port}`, Cookie: `sessionid=${config.sessions[index]}` };
  new WebSocket(`ws://127.0.0.1:${port}${config.site}`, { headers, perMessageDeflate: false }).on("message", (data) => (told.site += data.length));
}

async function joining() {
  await fill(config.steps);
  await rest(1500);
  const took = [];
  await say("begin");
  for (let round = 0; round < config.rounds; round += 1) {
    const began = performance.now();
    const client = open({});
    await until("a join", () => client.provider.synced && client.doc.getMap("steps").size >= config.steps);
    took.push(performance.now() - began);
    client.provider.destroy();
    await rest(20);
  }
  await say("end");
  return { took_ms: took };
}

/** From an edit to the word that it is saved, one after the other at no regular pace. */
async function saving() {
  let saved = 0;
  const client = open({ asks: [Uint8Array.of(SAVED)], seen: (kind, data) => {
    if (kind !== SAVED) return;
    const decoder = decoding.createDecoder(data);
    decoding.readVarUint(decoder);
    saved = decoding.readVarUint(decoder);
  } });
  await until("the join", () => client.provider.synced);
  const took = [];
  await say("begin");
  for (let round = 0; round < config.rounds; round += 1) {
    const began = performance.now();
    edit(client, 0, round);
    const wanted = client.frames;
    await until("saved", () => saved >= wanted);
    took.push(performance.now() - began);
    await rest(20 + ((round * 37) % 90));
  }
  await say("end");
  return { took_ms: took };
}

/** How long the loop answers nobody while a room of `room` opens: asked in another room for who is there. */
async function opening() {
  let asked = null, longest = 0;
  const small = open({ room: config.other, seen: (kind) => {
    if (kind === 1 && asked !== null) [longest, asked] = [Math.max(longest, performance.now() - asked), null];
  } });
  await until("the join", () => small.provider.synced);
  await rest(300);
  const ask = setInterval(() => {
    if (asked !== null) return;
    asked = performance.now();
    small.socket.send(Uint8Array.of(3));
  }, 9);
  await rest(500);
  const before = longest;
  longest = 0;
  await say("begin");
  const began = performance.now();
  const large = open({});
  await until("the large one", () => large.provider.synced && large.doc.getMap("steps").size >= config.steps);
  const took = performance.now() - began;
  await rest(1500);
  await say("end");
  clearInterval(ask);
  return { blocked_ms: longest, before_ms: before, joined_ms: took };
}

/** One after the other, connections that write a megabyte again and again, and then ask without end. */
async function flood() {
  await say("begin");
  const codes = [];
  for (let round = 0; round < config.rounds; round += 1) {
    const client = open({ index: round });
    client.provider.on("closed", (event) => codes.push(event.code));
    client.provider.on("connection-close", (event) => event && codes.push(event.code));
    await until("the join", () => client.provider.synced);
    for (let n = 0; n < 8; n += 1) {
      client.doc.getMap("parameters").set("big", String(n).repeat(1_000_000));
      await rest(50);
    }
    for (let n = 0; n < 3000 && client.socket.readyState === 1; n += 1) client.socket.send(Uint8Array.of(3));
    await rest(500);
    client.provider.destroy();
  }
  await say("end");
  return { codes };
}

const FLOODS = {
  texts: (client, n) => client.doc.getMap("parameters").set("big", String(n % 10).repeat(1_000_000)),
  updates: (client, n) => client.doc.transact(() => client.doc.getMap("parameters").set(`p${n % 50}`, n)),
  asks: (client) => client.socket.send(Uint8Array.of(3)),
  states: (client) => client.socket.send(Uint8Array.of(0, 0, 1, 0)),
  presence: (client, n) => client.provider.awareness.setLocalState({ cursor: [n, n], noise: "x".repeat(2000) }),
  noise: (client, n) => client.socket.send(new Uint8Array(20_000).fill(n % 251)),
};

/** Connections that are made and cut off as quickly as the server takes them, ten at once. */
async function coming(end, codes) {
  const port = config.ports[0];
  const headers = { Origin: `http://127.0.0.1:${port}`, Cookie: `sessionid=${config.sessions[0]}` };
  let made = 0;
  const one = () =>
    new Promise((done) => {
      const socket = new WebSocket(`ws://127.0.0.1:${port}${config.path}/${config.room}`, { headers, perMessageDeflate: false });
      socket.on("message", () => socket.terminate());
      socket.on("close", (code) => done((codes[code] = (codes[code] ?? 0) + 1)));
      socket.on("error", () => socket.terminate());
    });
  const again = async () => {
    for (; performance.now() < end; made += 1) await one();
  };
  await Promise.all(Array.from({ length: 10 }, again));
  return made;
}

/** As much of one kind as goes out, as somebody who comes again whenever they are cut off, until nobody listens. */
async function flooding() {
  const codes = {};
  let sent = 0;
  await say("begin");
  if (config.kind === "coming") sent = await coming(performance.now() + 1000 * config.seconds, codes);
  for (const end = performance.now() + 1000 * config.seconds; config.kind !== "coming" && performance.now() < end; await rest(100)) {
    const client = open({});
    client.provider.on("connection-close", (event) => event && (codes[event.code] = (codes[event.code] ?? 0) + 1));
    await until("the join", () => client.provider.synced || performance.now() > end).catch(() => {});
    for (let n = 0; client.socket.readyState === 1 && performance.now() < end; n += 1, sent += 1) {
      FLOODS[config.kind](client, n);
      if (n % 20 === 19 || config.kind === "texts") await rest(1);
    }
    client.provider.destroy();
  }
  await say("end");
  return { codes, sent };
}

async function only() {
  await fill(config.steps);
  await rest(2500);
  return {};
}

await say(await { together, joining, saving, opening, flood, flooding, only }[config.mode]());
process.exit(0);
