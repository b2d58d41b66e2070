/** Signing in by providers: which there are, and the way to one. */
import { useMutation, useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import type { SignOnProvider } from "@/api/types";

export const useProviders = () =>
  useQuery({
    queryKey: ["providers"],
    queryFn: () => api.get<SignOnProvider[]>("/sign-in/providers"),
    staleTime: Infinity,
  });

interface Wanted {
  provider: string;
  next: string;
  invitation: string;
}

/** Leave for the provider, which sends the browser back to the page of `SignOnPage`. */
export const useBeginSignOn = () =>
  useMutation({
    mutationFn: ({ provider, ...wanted }: Wanted) =>
      api.post<{ address: string }>(`/sign-in/providers/${encodeURIComponent(provider)}`, wanted),
    onSuccess: ({ address }) => location.assign(address),
  });
