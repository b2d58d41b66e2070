/** What the roles of a site allow; each may do all that the ones before it may. */
import type { Role } from "./types";

/** Commenters and whoever may more write comments. */
export function mayComment(role: Role | undefined): boolean {
  return role !== undefined && role !== "viewer";
}

/** Operators and whoever may more start runs, call devices and see to alerts. */
export function mayOperate(role: Role | undefined): boolean {
  return mayComment(role) && role !== "commenter";
}
