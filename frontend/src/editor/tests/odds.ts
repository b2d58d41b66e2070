/** What many seeds tell of tests, as the panel draws it. */
import i18next from "i18next";
import type { ProgramTest } from "@/api/types";

/** Virtual seconds from the least to the most of all tests: what bars of times are drawn on. */
export interface Scale {
  readonly from_s: number;
  readonly to_s: number;
}

/** The scale of the tests that were carried out with many seeds; null where none has passed with any. */
export function scaleOf(tests: readonly ProgramTest[]): Scale | null {
  const spans = tests.flatMap(({ result }) => result?.odds?.took_s ?? []);
  if (spans.length === 0) return null;
  return { from_s: Math.min(...spans.map(({ least }) => least)), to_s: Math.max(...spans.map(({ most }) => most)) };
}

/** `4 %`, `3.7 %`: a share as people of the language write it. */
export function formatShare(share: number): string {
  return new Intl.NumberFormat(i18next.language, { style: "percent", maximumFractionDigits: 1 }).format(share);
}
