/** A viewport that canvases follow without a React render. */
import type { Viewport } from "./projection";

export interface ViewportSource {
  get(): Viewport;
  /** Calls back after each change; returns how to stop. */
  subscribe(listener: () => void): () => void;
}

/** A viewport that its owner sets. */
export class ViewportCell implements ViewportSource {
  #value: Viewport;
  readonly #listeners = new Set<() => void>();

  constructor(value: Viewport = { x: 0, y: 0, zoom: 1 }) {
    this.#value = value;
  }

  get(): Viewport {
    return this.#value;
  }

  set(value: Viewport): void {
    this.#value = value;
    for (const listener of this.#listeners) listener();
  }

  subscribe(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }
}
