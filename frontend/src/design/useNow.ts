import { useEffect, useState } from "react";

/** Milliseconds since 1970, renewed every so often, so that "2 min ago" stays true. */
export function useNow(every_ms = 15_000): number {
  const [now, setNow] = useState(Date.now);
  useEffect(() => {
    const timer = setInterval(() => setNow(Date.now()), every_ms);
    return () => clearInterval(timer);
  }, [every_ms]);
  return now;
}
