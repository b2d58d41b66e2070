/** One person's script while it is edited: what is typed becomes edits of the drawing, the drawing comes into the text.

A text is always known together with the document that prints as it, the pair: a script is drawn over the pair's
document, so that only what was typed since changes the program, whatever other people did meanwhile. */
import type { Edit } from "../edits/edits";
import type { ProgramDocument } from "@/program/document/document";
import { differenceOf, withFreshIds } from "./difference";
import { mergeTexts, type Conflict } from "./textMerge";

export interface ScriptProblem {
  readonly line: number;
  readonly column: number;
  readonly end_line: number | null;
  readonly end_column: number | null;
  readonly message: string;
  readonly expected: string;
  readonly messages?: Readonly<Record<string, string>>;
  readonly hints?: Readonly<Record<string, string>>;
}

/** What the server made of a script. */
export interface DrawnScript {
  readonly ok: boolean;
  readonly stale: boolean;
  readonly document: ProgramDocument | null;
  readonly script: string;
  readonly lines: readonly string[];
  readonly diagnostics: readonly ScriptProblem[];
}

export interface ScriptRequest {
  readonly text: string;
  readonly base: ProgramDocument;
  readonly shown: string;
}

/** What a session needs of the open program. */
export interface ScriptHost {
  readonly draw: (request: ScriptRequest) => Promise<DrawnScript>;
  readonly getDocument: () => ProgramDocument;
  readonly apply: (edits: readonly Edit[]) => void;
  readonly makeId: () => string;
}

export interface ScriptState {
  readonly text: string;
  /** The text is this person's own and may differ from what the drawing prints. */
  readonly own: boolean;
  readonly problems: readonly ScriptProblem[];
  readonly conflicts: readonly Conflict[];
  /** Why the server could not be asked. */
  readonly failed: string | null;
}

interface Pair {
  readonly document: ProgramDocument;
  readonly script: string;
}

const REST: Omit<ScriptState, "text"> = { own: false, problems: [], conflicts: [], failed: null };
const PAUSE_MS = 200;
const RETRY_MS = 3000;

export class ScriptSession {
  readonly #host: ScriptHost;
  readonly #listeners = new Set<() => void>();
  #state: ScriptState = { text: "", ...REST };
  /** The last script that the site's compiler printed. */
  #printed = "";
  #pair: Pair | null = null;
  /** The text that was drawn last; null while the text means nothing. */
  #drawn: string | null = null;
  #timer: ReturnType<typeof setTimeout> | null = null;
  #working: Promise<void> | null = null;
  #again = false;
  #focused = false;

  constructor(host: ScriptHost) {
    this.#host = host;
  }

  readonly getState = (): ScriptState => this.#state;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  };

  /** The drawing prints as this now. */
  show(script: string): void {
    this.#printed = script;
    if (!this.#state.own) {
      if (this.#pair?.script !== script) this.#pair = null;
      this.#set({ text: script });
    } else if (this.#pair?.script !== script) this.#soon();
  }

  /** The person typed. */
  type(text: string): void {
    if (text === this.#state.text) return;
    this.#set({ text, own: true });
    this.#soon();
  }

  /** The person works in the text, or no longer does; a text that means something then gives way to its print. */
  focus(focused: boolean): void {
    this.#focused = focused;
    if (this.#state.own && !focused) void this.flush();
  }

  /** Give the own text up for what the drawing prints. */
  discard(): void {
    this.#pair = this.#drawn = null;
    this.#set({ text: this.#printed, ...REST });
  }

  /** Draw what was typed, without waiting for a pause. */
  async flush(): Promise<void> {
    if (this.#timer !== null) clearTimeout(this.#timer);
    this.#timer = null;
    this.#again = true;
    this.#working ??= this.#work().finally(() => {
      this.#working = null;
    });
    await this.#working;
  }

  #soon(pause = PAUSE_MS): void {
    if (this.#timer !== null) clearTimeout(this.#timer);
    this.#timer = setTimeout(() => void this.flush(), pause);
  }

  async #work(): Promise<void> {
    while (this.#again && this.#state.own) {
      this.#again = false;
      try {
        await this.#draw();
        await this.#catchUp();
        this.#set({ failed: null });
      } catch (error) {
        if (!(error instanceof Error)) throw error;
        this.#set({ failed: error.message });
        this.#soon(RETRY_MS);
      }
    }
    this.#rest();
  }

  /** Draw the text over the document from which it was edited. */
  async #draw(): Promise<void> {
    const pair = this.#pair ?? { document: this.#host.getDocument(), script: this.#printed };
    const { text } = this.#state;
    const drawn = await this.#host.draw({ text, base: pair.document, shown: pair.script });
    if (drawn.stale) {
      this.#pair = { document: pair.document, script: drawn.script };
      this.#set(mergeTexts(pair.script, this.#state.text, drawn.script));
      this.#again = true;
      return;
    }
    this.#pair = pair;
    this.#drawn = drawn.ok ? text : null;
    this.#set({ problems: drawn.diagnostics, ...(drawn.ok ? { conflicts: [] } : {}) });
    if (drawn.document) this.#apply(pair, { document: drawn.document, script: drawn.script, lines: drawn.lines });
  }

  #apply(pair: Pair, drawn: Pair & { readonly lines: readonly string[] }): void {
    const { document } = withFreshIds(drawn, pair.document, this.#host.makeId);
    const edits = differenceOf(pair.document, document);
    const alone = this.#host.getDocument() === pair.document;
    this.#host.apply(edits);
    this.#pair = { document: alone ? this.#host.getDocument() : document, script: drawn.script };
  }

  /** Bring what others drew meanwhile into the text. */
  async #catchUp(): Promise<void> {
    const document = this.#host.getDocument();
    const pair = this.#pair;
    if (!pair || document === pair.document) return;
    const drawn = await this.#host.draw({ text: this.#state.text, base: document, shown: pair.script });
    if (drawn.stale) this.#merge(pair, { document, script: drawn.script });
    else this.#pair = { document, script: pair.script };
  }

  /** A text that is drawn already takes what the drawing became; one that met others' lines waits until it means
   * something, and is then drawn first. */
  #merge(pair: Pair, theirs: Pair): void {
    const { text } = this.#state;
    const isDrawn = this.#drawn === text;
    this.#again = true;
    if (this.#drawn !== null && !isDrawn) return;
    const merged = mergeTexts(pair.script, text, theirs.script, isDrawn ? "theirs" : "mine");
    if (isDrawn || merged.conflicts.length === 0) {
      this.#pair = theirs;
      this.#drawn = null;
      this.#set({ text: merged.text, conflicts: [] });
    } else {
      this.#again = false;
      this.#set({ conflicts: merged.conflicts });
    }
  }

  /** Once the text is drawn and nobody works in it, it gives way to its print. */
  #rest(): void {
    const { own, text, failed } = this.#state;
    if (!own || this.#timer !== null || failed !== null || this.#drawn !== text) return;
    if (this.#focused && text !== this.#pair?.script) return;
    this.#set({ text: this.#pair?.script ?? this.#printed, ...REST });
  }

  #set(change: Partial<ScriptState>): void {
    const next = { ...this.#state, ...change };
    const same = (Object.keys(next) as (keyof ScriptState)[]).every((key) => next[key] === this.#state[key]);
    if (same) return;
    this.#state = next;
    for (const listener of this.#listeners) listener();
  }
}
