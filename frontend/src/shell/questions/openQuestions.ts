/** Which questions are worth showing: all open ones, and the last one if it was answered; pure. */
import type { Question } from "@/api/types";

export function shownQuestions(questions: readonly Question[]): Question[] {
  const last = questions.filter((each) => each.state !== "withdrawn").at(-1);
  return questions.filter((each) => each.state === "open" || each === last);
}

/** How many people are waited for. */
export function openCount(questions: readonly Question[]): number {
  return questions.filter((each) => each.state === "open").length;
}
