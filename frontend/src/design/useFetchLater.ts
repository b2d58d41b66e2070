/** Scripts that nobody waits for yet: fetched once the screen stands, so that what they are for opens at once. */
import { type ComponentType, lazy, useEffect } from "react";

/** So long after the screen has come; milliseconds. */
const FETCH_AFTER_MS = 2000;

/** Fetch these once; `loads` is the same each time. One that cannot be fetched is asked for again when it is opened. */
export function useFetchLater(loads: readonly (() => Promise<unknown>)[]): void {
  useEffect(() => {
    const fetchAll = () => loads.forEach((load) => void load().catch(() => {}));
    const timer = setTimeout(fetchAll, FETCH_AFTER_MS);
    return () => clearTimeout(timer);
  }, [loads]);
}

/** A part that nobody waits for, and without which one works all the same. */
export const beside = <Props extends object>(load: () => Promise<ComponentType<Props>>) =>
  lazy(() => load().then(as, () => as<Props>(() => null)));

const as = <Props>(found: ComponentType<Props>) => ({ default: found });
