/** Why the server does not take what is changed here. */
import type { Saving } from "./sharedProgram";

const REASONS = { 4400: "unreadable", 4404: "gone", 4413: "large", 4429: "many" } as const;

export type Reason = "viewer" | (typeof REASONS)[keyof typeof REASONS];

/** Why changes are not taken; null while they are, or while nobody knows. */
export function reasonOf({ connection, closedWith, notTaken }: Saving): Reason | null {
  if (connection === "refused") return REASONS[closedWith as keyof typeof REASONS] ?? null;
  return notTaken > 0 ? "viewer" : null;
}
