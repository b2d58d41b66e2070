import { QueryClient, QueryObserver } from "@tanstack/react-query";
import { expect, test } from "vitest";
import { missing } from "./failed";

const away = new Error("VIPO does not answer.");

test("what is known stays on the screen when it cannot be fetched anew", async () => {
  const queries = new QueryClient({ defaultOptions: { queries: { retry: false } } });
  let isThere = false;
  const look = new QueryObserver(queries, {
    queryKey: ["program"],
    queryFn: () => (isThere ? Promise.resolve("drawn") : Promise.reject(away)),
  });
  const leave = look.subscribe(() => undefined);
  expect(missing(look.getCurrentResult())).toBeNull();
  await expect.poll(() => missing(look.getCurrentResult())).toBe(away);
  isThere = true;
  await look.refetch();
  isThere = false;
  await look.refetch();
  expect([look.getCurrentResult().error, look.getCurrentResult().data]).toEqual([away, "drawn"]);
  expect(missing(look.getCurrentResult())).toBeNull();
  leave();
});
