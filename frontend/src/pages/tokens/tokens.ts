/** A site's tokens: read, made and revoked. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api } from "@/api/client";
import type { MadeToken, NewToken, Role, Token, TokenScope } from "@/api/types";

const keyOf = (slug: string) => ["tokens", slug] as const;
const pathOf = (slug: string) => `/sites/${encodeURIComponent(slug)}/tokens`;

export const useTokens = (slug: string) =>
  useQuery({ queryKey: keyOf(slug), queryFn: () => api.get<Token[]>(pathOf(slug)) });

export function useMakeToken(slug: string, onRefused: (error: Error) => void) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (wanted: NewToken) => api.post<MadeToken>(pathOf(slug), wanted),
    onError: onRefused,
    onSettled: () => queries.invalidateQueries({ queryKey: keyOf(slug) }),
  });
}

export function useRevokeToken(slug: string, onRefused: (error: Error) => void) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (token: Token) => api.delete(`${pathOf(slug)}/${token.id}`),
    onError: onRefused,
    onSettled: () => queries.invalidateQueries({ queryKey: keyOf(slug) }),
  });
}

const GIVEN_BY: Record<Role, readonly TokenScope[]> = {
  viewer: ["read", "operate", "broker"],
  commenter: ["read", "operate", "run", "broker"],
  operator: ["read", "operate", "run", "broker"],
  author: ["read", "operate", "run", "broker"],
  admin: ["read", "operate", "run", "admin", "broker"],
};

/** What somebody of a role may give a token. */
export const scopesOf = (role: Role): readonly TokenScope[] => GIVEN_BY[role];

/** Whether a scope cannot be chosen now: reading is part of all, and the broker goes with nothing else. */
export const isFixed = (scope: TokenScope, chosen: readonly TokenScope[]): boolean => {
  if (scope === "read") return true;
  const others = chosen.filter((one) => one !== "read" && one !== scope);
  return scope === "broker" ? others.length > 0 : others.includes("broker");
};
