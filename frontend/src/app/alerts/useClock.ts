import { useEffect, useState } from "react";

const EVERY_MS = 10_000;

/** Milliseconds since 1970, renewed often enough for "2 minutes ago". */
export function useClock(): number {
  const [now, setNow] = useState(Date.now);
  useEffect(() => {
    const timer = setInterval(() => setNow(Date.now()), EVERY_MS);
    return () => clearInterval(timer);
  }, []);
  return now;
}
