/** One socket that comes back by itself, later each time, and says how it stands. */

export interface ConnectionEvents {
  onMessage(message: unknown): void;
  onState(state: "connecting" | "live" | "reconnecting"): void;
  /** The server will not have us (signed out, no member): it stays closed. */
  onRefused(code: number): void;
}

const FIRST_WAIT_MS = 300;
const LONGEST_WAIT_MS = 8_000;

/** Milliseconds before the next attempt; `chance` from 0 to 1 keeps browsers from coming all at once. */
export function backOff(attempt: number, chance: number): number {
  const wait = Math.min(LONGEST_WAIT_MS, FIRST_WAIT_MS * 2 ** attempt);
  return wait * (0.5 + chance / 2);
}

export class LiveConnection {
  #socket: WebSocket | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #attempt = 0;
  #closed = false;

  constructor(
    private readonly url: string,
    private readonly events: ConnectionEvents,
  ) {
    events.onState("connecting");
    this.#open();
  }

  close(): void {
    this.#closed = true;
    clearTimeout(this.#timer);
    this.#socket?.close();
  }

  #open(): void {
    const socket = new WebSocket(this.url);
    this.#socket = socket;
    socket.onmessage = (event: MessageEvent<string>) => {
      if (this.#closed) return;
      this.#attempt = 0;
      this.events.onState("live");
      this.events.onMessage(JSON.parse(event.data));
    };
    socket.onclose = (event) => this.#lost(event.code);
  }

  #lost(code: number): void {
    if (this.#closed) return;
    if (code >= 4400 && code < 4500) {
      this.#closed = true;
      this.events.onRefused(code);
      return;
    }
    this.events.onState("reconnecting");
    this.#timer = setTimeout(() => this.#open(), backOff(this.#attempt, Math.random()));
    this.#attempt += 1;
  }
}
