/** A field that is kept when it is left. */
import { useEffect, useRef, useState } from "react";

/** Keep a value; whether it was taken. */
export type Keep<Value> = (value: Value) => boolean | Promise<boolean>;

/**
 * What a field shows: what is `known`, and what is typed or on its way, whatever becomes known meanwhile.
 *
 * `settle` keeps a value that is another than the known one. Where that is refused, what is known by then is shown
 * again, unless something else was typed meanwhile. What is on its way is not sent a second time, such as when the field
 * is left after Enter; `takeBack` goes back to it, or to what is known.
 */
export function useSettled<Value>(known: Value, keep: Keep<Value>) {
  const [value, setValue] = useState(known);
  const latest = useRef(known);
  const sent = useRef<{ readonly value: Value } | null>(null);
  const taken = useRef<{ readonly value: Value } | null>(null);
  useEffect(() => {
    const before = latest.current;
    latest.current = known;
    setValue((now) => (Object.is(now, before) || isOf(taken.current, now) ? known : now));
  }, [known]);
  const settle = (next: Value) => {
    setValue(next);
    if (Object.is(next, sent.current ? sent.current.value : known)) return;
    const mine = { value: next };
    const before = latest.current;
    sent.current = mine;
    taken.current = null;
    void Promise.resolve(keep(next)).then((isTaken) => {
      if (sent.current === mine) {
        sent.current = null;
        taken.current = isTaken ? mine : null;
      }
      // What somebody set behind it may be known before its answer comes.
      if (!isTaken || (sent.current === null && !Object.is(latest.current, before)))
        setValue((now) => (Object.is(now, next) ? latest.current : now));
    });
  };
  const takeBack = () => setValue(sent.current ? sent.current.value : known);
  return { value, setValue, settle, takeBack };
}

function isOf<Value>(kept: { readonly value: Value } | null, value: Value): boolean {
  return kept !== null && Object.is(kept.value, value);
}
