/** By which ways one signs in. */
import { useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import type { SignOnList } from "@/api/types";

export const WAYS_KEY = ["me", "sign-ons"] as const;

export const useWaysIn = () => useQuery({ queryKey: WAYS_KEY, queryFn: () => api.get<SignOnList>("/me/sign-ons") });
