/** A step in one sentence, for screen readers and lists. */
import type { Chip } from "./chips";
import { placeName, plainText, type Speaker } from "../words/stepWords";
import type { Place } from "../document/document";

/** "4a, Pick-and-Drop, 1 × box from Painting Machine to Curing Oven, inside Try 4, 1 error". */
export function chipLabel(chip: Chip, speaker: Speaker): string {
  const { t } = speaker;
  const step = speaker.document.steps[chip.id];
  const name = (field: string) => placeName(step?.params[field] as Place, speaker) ?? "?";
  const text = plainText(detailOf(chip));
  const where =
    chip.kind === "pick_and_drop"
      ? t("announce.from_to", { source: name("source"), target: name("target") })
      : chip.kind === "pick" || chip.kind === "drop"
        ? t("announce.at", { place: name("at") })
        : chip.kind === "operate"
          ? t("announce.at", { place: name("device") })
          : "";
  const problem =
    chip.errors > 0
      ? t("announce.problems", { count: chip.errors })
      : chip.problem
        ? t(`announce.${chip.problem}`)
        : "";
  const inside = chip.inside
    ? t("announce.inside", { kind: t(`kind.${chip.inside.kind}`), number: chip.inside.number }).trim()
    : "";
  const what = [text, where].filter(Boolean).join(" ");
  return [chip.number, t(`kind.${chip.kind}`), what, inside, problem].filter(Boolean).join(", ");
}

/** What a chip says beside the name of its kind. */
export function detailOf(chip: Pick<Chip, "kind" | "condition" | "parts">): Chip["parts"] {
  if (chip.condition) return chip.condition;
  return chip.parts[0]?.tone === "word" ? chip.parts.slice(1) : chip.parts;
}
