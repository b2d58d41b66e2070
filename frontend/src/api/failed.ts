/** Which of what a screen reads it cannot do without. */
import type { UseQueryResult } from "@tanstack/react-query";

type Read = Pick<UseQueryResult, "isLoadingError" | "error">;

/** Why there is nothing to show; null while something is known, even when it could not be fetched anew. */
export function missing(...reads: readonly Read[]): Error | null {
  return reads.find((read) => read.isLoadingError)?.error ?? null;
}
