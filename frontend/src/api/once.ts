/** What is begun by a press: pressed again because no answer came, it is the same thing, and is done once. */
import { useState } from "react";
import { api, ApiProblem } from "./client";

export type Begin = <T>(path: string, body: unknown) => Promise<T>;

/** Return a function that posts; until an answer has come, the same again has the same key. */
export function makeOnce(): Begin {
  let waiting = { said: "", key: "" };
  return async <T>(path: string, body: unknown): Promise<T> => {
    const said = `${path} ${JSON.stringify(body)}`;
    if (said !== waiting.said) waiting = { said, key: crypto.randomUUID() };
    try {
      const answer = await api.postOnce<T>(path, body, waiting.key);
      waiting = { said: "", key: "" };
      return answer;
    } catch (problem) {
      if (!isOpen(problem)) waiting = { said: "", key: "" };
      throw problem;
    }
  };
}

/** Whether it is not known what came of it: nobody answered, or not yet. */
function isOpen(problem: unknown): boolean {
  return problem instanceof ApiProblem && (problem.status === 0 || problem.code === "under_way");
}

export function useOnce(): Begin {
  return useState(makeOnce)[0];
}
