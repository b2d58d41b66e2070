import { useState } from "react";

/** Links and tokens that are shown this one time, one after the other: none takes another's place. */
export function useShownOnce<Secret>() {
  const [waiting, setWaiting] = useState<readonly Secret[]>([]);
  return {
    shown: waiting[0] ?? null,
    show: (secret: Secret) => setWaiting((all) => [...all, secret]),
    next: () => setWaiting((all) => all.slice(1)),
  };
}
