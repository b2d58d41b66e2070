/** The one grammar of values, asked of the server: text to value and back. */
import { api } from "@/api/client";
import type { Value } from "../../model/types";

export interface ExpressionProblem {
  readonly message: string;
  /** The message by language. */
  readonly messages: Readonly<Record<string, string>>;
  readonly column: number;
}

export interface ReadExpression {
  readonly value: Value;
  readonly text: string;
  readonly type: string;
  readonly unit: string;
  readonly problem: ExpressionProblem | null;
}

type Asked = { readonly text: string } | { readonly value: Value };

/** A text that stands for nothing comes back with its problem; only silence and refusals throw. */
export function readExpression(program: string, step: string, asked: Asked): Promise<ReadExpression> {
  return api.post<ReadExpression>(`/programs/${program}/expression`, { ...asked, step });
}
