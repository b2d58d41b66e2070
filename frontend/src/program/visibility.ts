/** Who sees a function of the library, from few to many. */
import type { LibraryFunction } from "@/api/types";

export type Visibility = LibraryFunction["visibility"];
export const VISIBILITIES: readonly Visibility[] = ["me", "site", "everyone"];
