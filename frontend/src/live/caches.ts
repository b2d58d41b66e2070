/** Puts live news into the query caches so that an answer under way, which may be older, does not undo it. */
import { hashKey, type Query, type QueryClient, type QueryKey } from "@tanstack/react-query";

type Change = (old: unknown) => unknown;
interface Late {
  changes: Change[];
  /** What was missed is not known: the answer under way is not trusted, and fetched once more. */
  again: boolean;
}

export class LiveCaches {
  readonly #late = new Map<string, Late>();
  readonly #unfollow: () => void;

  constructor(private readonly queries: QueryClient) {
    this.#unfollow = queries.getQueryCache().subscribe((event) => {
      const action = event.type === "updated" ? event.action : null;
      // What a fetch that failed had to be given is in the answer to the next one.
      if (event.type === "removed" || action?.type === "fetch") this.#late.delete(event.query.queryHash);
      if (action?.type === "success" && !action.manual) this.#arrived(event.query as Query);
    });
  }

  end(): void {
    this.#unfollow();
  }

  /** Change what is known; `change` must bear to be applied twice, and to a newer answer. */
  write<T>(key: QueryKey, change: (old: T) => T): void {
    if (this.#isUnderWay(key)) this.#lateOf(hashKey(key)).changes.push(change as Change);
    this.queries.setQueryData<T>(key, (old) => (old === undefined ? undefined : change(old)));
  }

  /**
   * Fetch anew all that is in use and whose key begins so, or those of them that are meant.
   *
   * The library leaves a first fetch alone when its query is invalidated; here it is followed by a second one.
   */
  refresh(queryKey: QueryKey, predicate: (query: Query) => boolean = () => true): void {
    const isFirst = (query: Query) => query.state.data === undefined && query.state.fetchStatus !== "idle";
    for (const query of this.queries.getQueryCache().findAll({ queryKey, predicate }))
      if (isFirst(query)) this.#lateOf(query.queryHash).again = true;
    void this.queries.invalidateQueries({ queryKey, predicate });
  }

  #isUnderWay(key: QueryKey): boolean {
    const status = this.queries.getQueryState(key)?.fetchStatus;
    return status !== undefined && status !== "idle";
  }

  #lateOf(hash: string): Late {
    const late = this.#late.get(hash) ?? { changes: [], again: false };
    this.#late.set(hash, late);
    return late;
  }

  #arrived(query: Query): void {
    const late = this.#late.get(query.queryHash);
    if (!late) return;
    this.#late.delete(query.queryHash);
    for (const change of late.changes) this.queries.setQueryData(query.queryKey, (old: unknown) => change(old));
    // After the fetch that has just ended has been put away.
    if (late.again)
      queueMicrotask(() => void this.queries.invalidateQueries({ queryKey: query.queryKey, exact: true }));
  }
}
