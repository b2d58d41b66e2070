/** What a test expected and what was seen, in the reader's language; results from before there were codes are English. */
import type { TestResult } from "@/api/types";
import { formatSpan } from "@/i18n/format";

export type Expectation = TestResult["expectations"][number];
export interface Sentence {
  readonly text: string;
  /** The language of the text, where it may be another one than the screen's. */
  readonly lang?: "en";
}

type Words = (key: string, values?: Record<string, unknown>) => string;
type Facts = Readonly<Record<string, unknown>>;

const isFacts = (value: unknown): value is Facts =>
  typeof value === "object" && value !== null && !Array.isArray(value);

/** "ends within 2 min 0 s" */
export function expectedWords({ kind, says, expected }: Expectation, t: Words): Sentence {
  const key = isFacts(says) ? expectedKey(kind, says) : null;
  return key && isFacts(says) ? { text: t(`tests.expects.${key}`, spelled(says)) } : { text: expected, lang: "en" };
}

function expectedKey(kind: string, says: Facts): string | null {
  switch (kind) {
    case "ends":
    case "fails":
    case "within_s":
    case "commands":
      return kind;
    case "item":
      return says.count === undefined || says.count === null ? "item_some" : "item";
    case "never_two_in":
      return "zone" in says ? "never_two_in" : "never_two_near";
    case "property":
      return `property_${String(says.word)}`;
    case "step":
      return says.times === undefined || says.times === null ? "step" : "step_times";
    default:
      return null;
  }
}

const SEEN = new Set(
  "ended_well not_well took touched error holds two_were never_met came not_come not_come_after was_at was_from was never_shown times".split(
    " ",
  ),
);

/** "it took 3 min 4 s"; what went wrong in a step is told in the machine's own words. */
export function seenWords({ seen, saw }: Expectation, t: Words): Sentence {
  const { code } = seen;
  return typeof code === "string" && SEEN.has(code)
    ? { text: t(`tests.seen.${code}`, spelled(seen)) }
    : { text: saw, lang: "en" };
}

/** The facts as they stand in a sentence: times as spans, lists with commas. */
function spelled(facts: Facts): Record<string, unknown> {
  const told: Record<string, unknown> = {};
  for (const [name, value] of Object.entries(facts)) {
    if ((name === "t_s" || name === "most_s") && typeof value === "number") told.time = formatSpan(value);
    else told[name] = Array.isArray(value) ? value.join(", ") : value;
  }
  return told;
}
