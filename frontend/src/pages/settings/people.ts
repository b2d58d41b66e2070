/** The people of a site: members, invitations, who may do what, and what was done; read and changed. */
import { useInfiniteQuery, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api, untilRefused } from "@/api/client";
import type {
  AuditEntry,
  Deed,
  FactorRule,
  InvitationList,
  MadeInvitation,
  MadeWallScreen,
  Member,
  MemberChange,
  MemberDetail,
  NewInvitation,
  NewWallScreen,
  WallScreen,
} from "@/api/types";

const EVERY_MS = 15_000;
const PART = 50;
const siteOf = (slug: string) => `/sites/${encodeURIComponent(slug)}`;
const keyOf = (slug: string) => ["people", slug] as const;

export const useMembers = (slug: string) =>
  useQuery({
    queryKey: [...keyOf(slug), "members"],
    queryFn: () => api.get<Member[]>(`${siteOf(slug)}/members`),
    refetchInterval: untilRefused(EVERY_MS),
  });

/** A member with what ends when they are removed; always asked for anew. */
export const useMember = (slug: string, id: number) =>
  useQuery({
    queryKey: [...keyOf(slug), "member", id],
    queryFn: () => api.get<MemberDetail>(`${siteOf(slug)}/members/${id}`),
    gcTime: 0,
    staleTime: 0,
  });

export const useInvitations = (slug: string) =>
  useQuery({
    queryKey: [...keyOf(slug), "invitations"],
    queryFn: () => api.get<InvitationList>(`${siteOf(slug)}/invitations`),
    refetchInterval: untilRefused(EVERY_MS),
  });

export const useFactorRule = (slug: string) =>
  useQuery({
    queryKey: [...keyOf(slug), "factor"],
    queryFn: () => api.get<FactorRule>(`${siteOf(slug)}/second-factor`),
  });

export const useSetFactorRule = (slug: string) =>
  useChange(slug, (role: FactorRule["demanded_from"]) =>
    api.put<FactorRule>(`${siteOf(slug)}/second-factor`, { demanded_from: role }),
  );

export const useRights = () =>
  useQuery({ queryKey: ["rights"], queryFn: () => api.get<Deed[]>("/rights"), staleTime: Infinity });

export const KINDS = [
  "roles",
  "invitations",
  "tokens",
  "wall_screens",
  "runs",
  "stops",
  "devices",
  "programs",
  "map",
  "sign_in",
] as const satisfies readonly AuditEntry["kind"][];
export type AuditFilter = AuditEntry["kind"] | "all";

const ofKind = (filter: AuditFilter) => (filter === "all" ? "" : `kind=${filter}`);

export const exportPath = (slug: string, filter: AuditFilter) => `/api${siteOf(slug)}/audit.csv?${ofKind(filter)}`;

/** What was done, the newest first, as far back as was asked for. */
export const useAudit = (slug: string, filter: AuditFilter) =>
  useInfiniteQuery({
    queryKey: [...keyOf(slug), "audit", filter],
    queryFn: ({ pageParam }) => api.part<AuditEntry>(pageParam),
    initialPageParam: `${siteOf(slug)}/audit?limit=${PART}&${ofKind(filter)}`,
    getNextPageParam: (last) => last.next,
    refetchInterval: untilRefused(EVERY_MS),
  });

type Refused = (error: Error) => void;

/** Something that is changed about the people of a site; all of it is read anew afterwards. */
function useChange<Wanted, Told>(slug: string, change: (wanted: Wanted) => Promise<Told>, onRefused?: Refused) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: change,
    onError: onRefused,
    onSettled: () => queries.invalidateQueries({ queryKey: keyOf(slug) }),
  });
}

export const useChangeMember = (slug: string, onRefused?: Refused) =>
  useChange(
    slug,
    ({ id, ...change }: MemberChange & { id: number }) => api.patch<Member>(`${siteOf(slug)}/members/${id}`, change),
    onRefused,
  );
export const useRemoveMember = (slug: string, onRefused: Refused) =>
  useChange(slug, (id: number) => api.delete(`${siteOf(slug)}/members/${id}`), onRefused);
export const useResetFactor = (slug: string, onRefused: Refused) =>
  useChange(slug, (id: number) => api.delete(`${siteOf(slug)}/members/${id}/second-factor`), onRefused);
export const useLeave = (slug: string, onRefused: Refused) =>
  useChange(slug, () => api.post(`${siteOf(slug)}/leave`), onRefused);
export const useInvite = (slug: string, onRefused: Refused) =>
  useChange(
    slug,
    (wanted: NewInvitation) => api.post<MadeInvitation>(`${siteOf(slug)}/invitations`, wanted),
    onRefused,
  );
export const useWallScreens = (slug: string) =>
  useQuery({
    queryKey: [...keyOf(slug), "wallScreens"],
    queryFn: () => api.get<WallScreen[]>(`${siteOf(slug)}/wall-screens`),
    refetchInterval: untilRefused(EVERY_MS),
  });
export const useMakeWallScreen = (slug: string, onRefused: Refused) =>
  useChange(
    slug,
    (wanted: NewWallScreen) => api.post<MadeWallScreen>(`${siteOf(slug)}/wall-screens`, wanted),
    onRefused,
  );
export const useTurnOff = (slug: string) =>
  useChange(slug, (id: number) => api.delete(`${siteOf(slug)}/wall-screens/${id}`));
export const useRevoke = (slug: string) =>
  useChange(slug, (id: number) => api.delete(`${siteOf(slug)}/invitations/${id}`));

/** Whether a member is the only one who looks after the site for good: the server lets such a one not go. */
export function isLastAdmin(member: Member, members: readonly Member[]): boolean {
  const lasting = members.filter((each) => each.role === "admin" && each.ends_at === null && !each.is_closed);
  return lasting.length === 1 && lasting[0]?.id === member.id;
}

/** Members whose name or address holds what was typed. */
export function findMembers(members: readonly Member[], typed: string): Member[] {
  const wanted = typed.trim().toLowerCase();
  return members.filter((each) => `${each.name} ${each.email}`.toLowerCase().includes(wanted));
}

/** The last moment of a day as a field of dates says it, here where people look; undefined for what is no day. */
export function endOfDay(typed: string): string | undefined {
  const end = new Date(`${typed}T23:59:59`);
  return Number.isNaN(end.getTime()) ? undefined : end.toISOString();
}

/** The day in which a moment lies here where people look, as a field of dates says it; what `endOfDay` takes back. */
export function dayOf(moment: Date): string {
  return new Date(moment.getTime() - moment.getTimezoneOffset() * 60_000).toISOString().slice(0, 10);
}
