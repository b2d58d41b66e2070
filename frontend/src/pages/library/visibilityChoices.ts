/** Who sees a function of the library, from few to many. */
import { Globe, Lock, type LucideIcon, Users } from "lucide-react";
import type { LibraryFunction } from "@/api/types";

export type Visibility = LibraryFunction["visibility"];
export const VISIBILITIES: readonly Visibility[] = ["me", "site", "everyone"];
export const VISIBILITY_SIGNS: Readonly<Record<Visibility, LucideIcon>> = { me: Lock, site: Users, everyone: Globe };
