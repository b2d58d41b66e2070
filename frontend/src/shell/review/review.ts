/** How a program's content stands in its review, and what people say about it. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { AskedReview, Review } from "@/api/types";
import type { Fact } from "@/design/FactList";
import { useTellUnseen } from "../refusal";

export type Verdict = "approved" | "changes" | "withdrawn";

const pathOf = (program: string) => `/programs/${encodeURIComponent(program)}/review`;

/** The review of a version, or of what is drawn now (null); undefined asks for nothing. */
export const useReview = (program: string, version: number | null | undefined) =>
  useQuery({
    queryKey: [...keys.reviews, program, version ?? "draft"],
    queryFn: () => api.get<Review>(pathOf(program) + (version ? `?version=${version}` : "")),
    enabled: version !== undefined,
    staleTime: 0,
  });

/** The versions of the site that wait for this person's review. */
export const useAskedReviews = (slug: string) =>
  useQuery({
    queryKey: [...keys.reviews, "asked", slug],
    queryFn: () => api.get<AskedReview[]>(`/sites/${encodeURIComponent(slug)}/reviews`),
  });

/** Where a version is reviewed: beside what was approved before it; the first one beside itself. */
export function reviewAddress({ program, number, compare_with }: AskedReview): string {
  return `/programs/${program}/compare?old=${compare_with ?? number}&new=${number}`;
}

/** Ask for a review; what is drawn now becomes a version first. `before` waits until the server has it. */
export function useAskForReview(program: string, version: number | null, before?: () => Promise<void>) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: async (note: string) => {
      await before?.();
      return api.post<Review>(`${pathOf(program)}/ask`, { version, note });
    },
    onError: useTellUnseen(),
    onSuccess: () => queries.invalidateQueries({ queryKey: keys.reviews }),
  });
}

export function useVerdict(program: string, version: number) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (said: { verdict: Verdict; note: string }) => api.post<Review>(pathOf(program), { version, ...said }),
    onSuccess: () => queries.invalidateQueries({ queryKey: keys.reviews }),
  });
}

/** Whether there is anything to show: the site demands approvals, or somebody has said something. */
export function isReviewed(review: Review | undefined): review is Review {
  return review !== undefined && (review.needed > 0 || review.history.length > 0);
}

type Words = (key: string, values?: Record<string, unknown>) => string;

/** What there is to say of a review, the most important first. */
export function factsOf(review: Review, t: Words): readonly Fact[] {
  const saying = (kind: string) => review.history.filter((word) => word.kind === kind && word.counts);
  const asked = review.history.filter((word) => word.kind === "asked").at(-1);
  const objections = saying("changes").map((word): Fact => ({
    tone: "error",
    text: t("review.wants_changes", { name: word.name, note: word.note }),
  }));
  const given = standingOf(
    review.needed,
    saying("approved").map((word) => word.name),
    t,
  );
  const waits: Fact[] =
    asked && !review.may_run
      ? [{ tone: "plain", text: t(asked.note ? "review.asked_note" : "review.asked", { ...asked }) }]
      : [];
  return [...objections, ...given, ...waits];
}

function standingOf(needed: number, names: readonly string[], t: Words): readonly Fact[] {
  const people = names.join(", ");
  if (names.length >= needed)
    return names.length > 0 ? [{ tone: "done", text: t("review.approved_by", { people }) }] : [];
  const text =
    names.length === 0
      ? t("review.given_none", { needed })
      : t("review.given_some", { given: names.length, needed, people });
  return [{ tone: "warn", text }];
}

/** What the checker finds, as a fact beside what people say. */
export function findingsOf({ errors, warnings }: Review, t: Words): readonly Fact[] {
  if (errors === null || warnings === null) return [];
  if (errors + warnings === 0) return [{ tone: "done", text: t("review.findings_none") }];
  return [{ tone: errors > 0 ? "error" : "warn", text: t("review.findings", { errors, warnings }) }];
}
