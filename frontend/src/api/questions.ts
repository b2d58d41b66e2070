/** What runs ask people, and programs that start by themselves. */

import type { Scalar } from "./values";

export interface AnswerSpec {
  type: "boolean" | "number" | "text" | "choice";
  unit: string;
  minimum: number | null;
  maximum: number | null;
  options: string[];
}

/** Something that a run asks the people of its site. */
export interface Question {
  id: string;
  run: string;
  run_number: number;
  program: { id: string; name: string };
  site: string;
  step: string;
  text: string;
  answer: AnswerSpec;
  state: "open" | "answered" | "withdrawn";
  value: Scalar | null;
  asked_at: string;
  answered_by: string;
  answered_at: string | null;
}

/** A program that starts by itself. */
export interface ArmedProgram {
  program: string;
  version: number;
  by: string;
  at: string;
}
