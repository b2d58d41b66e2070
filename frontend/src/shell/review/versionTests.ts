/** How the tests of a program came out on each of its versions. */
import { useQuery } from "@tanstack/react-query";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { VersionTests } from "@/api/types";
import type { Fact } from "@/design/FactList";

export const useVersionTests = (program: string) =>
  useQuery({
    queryKey: [...keys.tests(program), "versions"],
    queryFn: () => api.get<VersionTests[]>(`/programs/${encodeURIComponent(program)}/version-tests`),
    staleTime: 0,
  });

type Words = (key: string, values?: Record<string, unknown>) => string;

/** "6 of 7 tests pass", as a fact; null for a version without tests, and where a run of them was cancelled. */
export function factOfTests(tests: VersionTests | undefined, t: Words): Fact | null {
  if (!tests || tests.status === "cancelled") return null;
  const { status, passed, total } = tests;
  if (status === "failed") return { tone: "error", text: t("tests.of_version_failed") };
  if (status !== "done") return { tone: "plain", text: t("tests.of_version_waits") };
  return { tone: passed === total ? "done" : "error", text: t("tests.pass", { passed, count: total }) };
}
