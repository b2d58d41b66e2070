/** The compiled form of the open program: whole at first, then what each edit, whoever made it, changed in it. */
import * as decoding from "lib0/decoding";
import * as encoding from "lib0/encoding";
import type { WebsocketProvider } from "y-websocket";
import type { Compiled } from "@/api/types";
import { applyPatch } from "@/program/compiledPatch";
import type { CompiledPatch } from "@/program/compiledPatch";

/** The server's own message: JSON; a browser asks for it by the revision that it has, 0 for none. */
const MESSAGE_COMPILED = 101;

export class CompiledForm {
  readonly #listeners = new Set<() => void>();
  #form: Compiled | null = null;

  constructor(private readonly provider: WebsocketProvider) {
    provider.messageHandlers[MESSAGE_COMPILED] = (_encoder, decoder) => {
      const told = new TextDecoder().decode(decoding.readVarUint8Array(decoder));
      this.#take(JSON.parse(told) as Compiled | CompiledPatch);
    };
    provider.on("status", ({ status }) => {
      if (status === "connected") this.#ask();
    });
  }

  readonly get = (): Compiled | null => this.#form;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  };

  #take(told: Compiled | CompiledPatch): void {
    const form = "base" in told ? this.#form && applyPatch(this.#form, told) : told;
    this.#form = form ?? this.#form;
    if (!form) return this.#ask();
    for (const listener of this.#listeners) listener();
  }

  /** Ask for the form; after a patch that does not fit, for all of it. */
  #ask(): void {
    const encoder = encoding.createEncoder();
    encoding.writeVarUint(encoder, MESSAGE_COMPILED);
    encoding.writeVarUint(encoder, this.#form?.revision ?? 0);
    this.provider.ws?.send(encoding.toUint8Array(encoder));
  }
}
