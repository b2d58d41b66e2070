/** A site's tokens: read, made and revoked. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api } from "@/api/client";
import type { MadeToken, NewToken, Role, Token, TokenScope } from "@/api/types";

const keyOf = (slug: string) => ["tokens", slug] as const;
const pathOf = (slug: string) => `/sites/${encodeURIComponent(slug)}/tokens`;

export const useTokens = (slug: string) =>
  useQuery({ queryKey: keyOf(slug), queryFn: () => api.get<Token[]>(pathOf(slug)) });

export function useMakeToken(slug: string) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (wanted: NewToken) => api.post<MadeToken>(pathOf(slug), wanted),
    onSettled: () => queries.invalidateQueries({ queryKey: keyOf(slug) }),
  });
}

export function useRevokeToken(slug: string) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (token: Token) => api.delete(`${pathOf(slug)}/${token.id}`),
    onSettled: () => queries.invalidateQueries({ queryKey: keyOf(slug) }),
  });
}

const GIVEN_BY: Record<Role, readonly TokenScope[]> = {
  viewer: ["read", "operate"],
  operator: ["read", "operate", "run"],
  author: ["read", "operate", "run"],
  admin: ["read", "operate", "run", "admin"],
};

/** What somebody of a role may give a token. */
export const scopesOf = (role: Role): readonly TokenScope[] => GIVEN_BY[role];
