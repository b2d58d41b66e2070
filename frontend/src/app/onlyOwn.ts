/** What this page knows is what the person may see who is signed in. */
import { notifications } from "@mantine/notifications";
import { hashKey, type Query, type QueryClient } from "@tanstack/react-query";
import { keys } from "@/api/queries";
import type { Me } from "@/api/types";
import { forgetLive } from "@/live/site";
import { useShownKeys } from "@/pages/devices/keys/shownKey";

const ME = hashKey(keys.me);

/** Forget everything that was fetched for or told to a person as soon as another is signed in, or nobody. */
export function forgetOthers(queries: QueryClient): void {
  let person: number | null = null;
  queries.getQueryCache().subscribe(({ type, query }) => {
    if (type !== "updated" || query.queryHash !== ME || query.state.data === undefined) return;
    const before = person;
    person = (query.state.data as Me).user?.id ?? null;
    if (before !== null && person !== before) forget(queries, person !== null);
  });
}

function forget(queries: QueryClient, isAnybody: boolean): void {
  const predicate = ({ queryHash }: Query) => queryHash !== ME;
  // What is on the screen of a person whose place another has taken is emptied, and fetched for them.
  if (isAnybody) void queries.resetQueries({ predicate });
  else queries.removeQueries({ predicate });
  forgetLive(isAnybody);
  useShownKeys.setState([], true);
  notifications.clean(); // what they say and offer was for who has left
}
