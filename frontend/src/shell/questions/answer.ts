/** What is typed into a question's field, read as its answer; pure. */
import type { AnswerSpec, Scalar } from "@/api/types";

export type Reading = { value: Scalar } | { problem: "number" | "low" | "high" | "choose" };

/** Read a field; `typed` is what the field holds. */
export function readAnswer(spec: AnswerSpec, typed: string | number): Reading {
  if (spec.type === "number") return readNumber(spec, typed);
  if (spec.type === "choice" && !spec.options.includes(String(typed))) return { problem: "choose" };
  return { value: String(typed).trim() };
}

function readNumber({ minimum, maximum }: AnswerSpec, typed: string | number): Reading {
  const value = typeof typed === "number" ? typed : Number(typed.trim().replace(",", "."));
  if (typed === "" || !Number.isFinite(value)) return { problem: "number" };
  if (minimum !== null && value < minimum) return { problem: "low" };
  if (maximum !== null && value > maximum) return { problem: "high" };
  return { value };
}
