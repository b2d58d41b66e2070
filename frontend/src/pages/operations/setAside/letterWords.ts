/** What was set aside in plain words, and what is lost with it. */
import i18next from "i18next";
import type { DeadLetter } from "@/api/types";

const WORDS = "operations.setAside";
/** What stands for something that no message said, as in execution/engine/dead_letters.py. */
const UNSAID: ReadonlySet<string> = new Set(["start", "step", "plan", "facts"]);
const OVER: ReadonlySet<string> = new Set(["finished", "failed", "cancelled"]);

function typeOf(letter: DeadLetter): string {
  const { type } = letter.event as { type?: unknown };
  return typeof type === "string" ? type : "unreadable";
}

export const isOver = (letter: DeadLetter) => letter.run_status !== null && OVER.has(letter.run_status);

/** One sentence about what could not be taken in; a kind that this page does not know is named as it is. */
export function whatWords(letter: DeadLetter): string {
  const type = typeOf(letter);
  const special = `${WORDS}.what.${type}`;
  if (i18next.exists(special)) return i18next.t(special);
  const key = `${WORDS}.${letter.target}.${type}`;
  const what = i18next.exists(key) ? i18next.t(key) : i18next.t(`${WORDS}.unknown`, { type });
  return i18next.t(`${WORDS}.notTakenIn`, { what });
}

/** What is lost when it is dropped. */
export function lossWords(letter: DeadLetter): string {
  const run = letter.run_number;
  if (run === null) return i18next.t(`${WORDS}.loss.floor`);
  if (isOver(letter)) return i18next.t(`${WORDS}.loss.over`, { run });
  return i18next.t(`${WORDS}.loss.${UNSAID.has(typeOf(letter)) ? "entry" : "message"}`, { run });
}

/** What the message says, as it is kept. */
export const eventText = (letter: DeadLetter) => JSON.stringify(letter.event, null, 2);
