/** What this browser keeps follows who is signed in. */
import { useEffect, useState } from "react";
import { keepOnlyOf, listCopies } from "@/api/localCopies";
import { useMe } from "@/api/queries";

/** Remove what is not for whoever is signed in, as soon as that is known. */
export function useKeepOnlyOwn(): void {
  const me = useMe().data;
  const person = me && (me.user ? String(me.user.id) : null);
  useEffect(() => {
    if (person !== undefined) void keepOnlyOf(person).catch(() => {}); // a browser that keeps nothing has nothing
  }, [person]);
}

/** How many changes wait here while nobody is signed in. */
export function useWaitingCount(): number {
  const [count, setCount] = useState(0);
  useEffect(() => {
    const add = (copies: Awaited<ReturnType<typeof listCopies>>) =>
      setCount(copies.reduce((sum, copy) => sum + copy.waiting, 0));
    void listCopies().then(add, () => {});
  }, []);
  return count;
}
