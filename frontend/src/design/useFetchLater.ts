/** Scripts that nobody waits for yet: fetched once the screen stands, so that what they are for opens at once. */
import { useEffect } from "react";

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
