/**
 * Which of one's own changes are in the server's database. The server counts the messages with content that a connection
 * has sent, and tells how many of them, from the first on, are stored, and how many it did not take.
 */
import * as decoding from "lib0/decoding";
import type { WebsocketProvider } from "y-websocket";

/** The server's own message; a browser that sends it is told. */
const MESSAGE_SAVED = 100;
const SYNC = 0;
const SYNC_STEP_1 = 0;

type Messages = WebsocketProvider["messageHandlers"];

/** Waiting is worth a word only after this time: the server stores what comes every quarter of a second. */
export const MOMENT_MS = 1000;

export class SavedChanges {
  /** What y-websocket shall connect with: it sees what is sent. */
  readonly Socket: typeof WebSocket;
  #made = 0;
  #stored = 0;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** When each change that waits was made, the oldest first. */
  #since: number[] = [];
  #refused = 0;
  #frames = 0;
  #marks: { frame: number; made: number }[] = [];

  constructor(private readonly changed: () => void) {
    const begin = () => this.#begin();
    const note = (data: unknown) => this.#note(data);
    this.Socket = class extends WebSocket {
      constructor(url: string | URL, protocols?: string | string[]) {
        super(url, protocols);
        begin();
        this.addEventListener("open", () => super.send(Uint8Array.of(MESSAGE_SAVED)));
      }

      override send(data: Parameters<WebSocket["send"]>[0]): void {
        super.send(data);
        note(data);
      }
    };
  }

  /** How many of one's own changes are not known to be stored. */
  get waiting(): number {
    return this.#made - this.#stored;
  }

  /** How many are known to be stored, of pages before this one, too. */
  get stored(): number {
    return this.#stored;
  }

  /** Something of one's own has waited longer than a moment. */
  get late(): boolean {
    const [oldest] = this.#since;
    return oldest !== undefined && Date.now() - oldest >= MOMENT_MS;
  }

  /** How many messages of this connection the server did not take, since whoever sends them may only look. */
  get refused(): number {
    return this.#refused;
  }

  /** Count a change of one's own; before it is sent. */
  made(): void {
    this.#made += 1;
    this.#since.push(Date.now());
    this.#watch();
    this.changed();
  }

  /** Count what pages before this one have made and did not hear about; before the first connection. */
  madeBefore(count: number): void {
    this.#made += count;
    this.#since.unshift(...Array.from({ length: count }, () => 0));
    this.changed();
  }

  close(): void {
    clearTimeout(this.#timer);
  }

  listen(handlers: Messages): void {
    handlers[MESSAGE_SAVED] = (_encoder, decoder) => {
      const stored = decoding.readVarUint(decoder);
      this.#refused = decoding.readVarUint(decoder);
      // What was not taken is not stored, though its message is done with.
      if (this.#refused === 0) this.#store(stored);
      this.changed();
    };
  }

  #store(frames: number): void {
    const before = this.#stored;
    while (this.#marks[0] && this.#marks[0].frame <= frames) this.#stored = this.#marks.shift()?.made ?? 0;
    this.#since.splice(0, this.#stored - before);
    this.#watch();
  }

  /** Say so when the oldest change has waited for a moment. */
  #watch(): void {
    clearTimeout(this.#timer);
    const [oldest] = this.#since;
    const wait = (oldest ?? 0) + MOMENT_MS - Date.now();
    if (oldest !== undefined && wait > 0) this.#timer = setTimeout(() => this.changed(), wait);
  }

  #begin(): void {
    this.#frames = this.#refused = 0;
    this.#marks = [];
  }

  #note(data: unknown): void {
    const bytes = data instanceof Uint8Array ? data : null;
    if (bytes?.[0] !== SYNC || bytes[1] === SYNC_STEP_1) return;
    this.#frames += 1;
    this.#marks.push({ frame: this.#frames, made: this.#made });
  }
}
