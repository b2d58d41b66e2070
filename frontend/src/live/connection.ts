/** One socket that comes back by itself, later each time, and says how it stands. */

/** `crowded`: so many are open that the server takes no other; it is tried again, slowly. */
export type LineState = "connecting" | "live" | "reconnecting" | "crowded";

export interface ConnectionEvents {
  onMessage(message: unknown): void;
  onState(state: LineState): void;
  /** The server will not have us (signed out, no member): it stays closed. */
  onRefused(code: number): void;
}

const FIRST_WAIT_MS = 300;
const LONGEST_WAIT_MS = 8_000;
const CROWDED = 4429;
const CROWDED_WAIT_MS = 30_000;
/** The server says something every 5 s; a line that is silent for longer is dead, though no browser says so. */
export const SILENCE_MS = 15_000;

/** Milliseconds before the next attempt; `chance` from 0 to 1 keeps browsers from coming all at once. */
export function backOff(attempt: number, chance: number): number {
  const wait = Math.min(LONGEST_WAIT_MS, FIRST_WAIT_MS * 2 ** attempt);
  return wait * (0.5 + chance / 2);
}

export class LiveConnection {
  #socket: WebSocket | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #silence: ReturnType<typeof setTimeout> | undefined;
  #attempt = 0;

  constructor(
    private readonly url: string,
    private readonly events: ConnectionEvents,
  ) {
    events.onState("connecting");
    window.addEventListener("offline", this.#dead);
    window.addEventListener("online", this.#back);
    this.#open();
  }

  close(): void {
    this.#end();
    this.#drop();
  }

  #end(): void {
    clearTimeout(this.#timer);
    clearTimeout(this.#silence);
    window.removeEventListener("offline", this.#dead);
    window.removeEventListener("online", this.#back);
  }

  #open(): void {
    const socket = new WebSocket(this.url);
    this.#socket = socket;
    this.#listen();
    socket.onmessage = (event: MessageEvent<string>) => {
      this.#listen();
      this.#attempt = 0;
      this.events.onState("live");
      this.events.onMessage(JSON.parse(event.data));
    };
    socket.onclose = (event) => this.#lost(event.code);
  }

  #listen(): void {
    clearTimeout(this.#silence);
    this.#silence = setTimeout(this.#dead, SILENCE_MS);
  }

  /** Leave the socket to itself: on a dead line its close may take minutes. */
  #drop(): void {
    const socket = this.#socket;
    this.#socket = null;
    if (!socket) return;
    socket.onmessage = socket.onclose = null;
    socket.close();
  }

  readonly #dead = (): void => {
    if (!this.#socket) return;
    this.#drop();
    this.#again();
  };

  readonly #back = (): void => {
    if (this.#socket) return;
    clearTimeout(this.#timer);
    this.#open();
  };

  #lost(code: number): void {
    this.#socket = null;
    if (code === CROWDED) return this.#waitFor("crowded", CROWDED_WAIT_MS * (0.5 + Math.random() / 2));
    if (code >= 4400 && code < 4500) {
      this.#end();
      this.events.onRefused(code);
      return;
    }
    this.#again();
  }

  #again(): void {
    this.#waitFor("reconnecting", backOff(this.#attempt, Math.random()));
    this.#attempt += 1;
  }

  #waitFor(state: LineState, wait_ms: number): void {
    clearTimeout(this.#silence);
    this.events.onState(state);
    this.#timer = setTimeout(() => this.#open(), wait_ms);
  }
}
