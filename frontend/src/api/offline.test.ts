import { MutationObserver, onlineManager, QueryObserver } from "@tanstack/react-query";
import { afterEach, expect, test } from "vitest";
import { makeQueryClient } from "./queries";

const queries = makeQueryClient();
const silence = () => Promise.reject(new Error("no network"));

afterEach(() => {
  onlineManager.setOnline(true);
  queries.clear();
});

test("what is pressed without a network fails at once and is not done later", async () => {
  onlineManager.setOnline(false);
  let pressed = 0;
  const press = () => {
    pressed += 1;
    return silence();
  };
  await expect(new MutationObserver(queries, { mutationFn: press }).mutate()).rejects.toThrow("no network");
  onlineManager.setOnline(true);
  await queries.resumePausedMutations();
  expect(pressed).toBe(1);
});

test("what is looked up without a network says so, and is looked up again with one", async () => {
  onlineManager.setOnline(false);
  const answers = [silence, () => Promise.resolve("here")];
  const look = new QueryObserver(queries, { queryKey: ["device"], queryFn: () => answers.shift()?.() ?? "here" });
  const leave = look.subscribe(() => undefined);
  await expect.poll(() => look.getCurrentResult().status).toBe("error");
  queries.mount();
  onlineManager.setOnline(true);
  await expect.poll(() => look.getCurrentResult().data).toBe("here");
  queries.unmount();
  leave();
});
