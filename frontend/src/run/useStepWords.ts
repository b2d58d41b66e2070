import { useMemo } from "react";
import type { ProgramDocument } from "@/api/types";
import { useEditorText } from "@/program/canvas/useScene";
import { kindOf } from "@/program/kinds";
import { surroundingsOf, type SiteDevice } from "@/program/surroundings";
import { chipText, conditionText, placeName, plainText } from "@/program/words/stepWords";
import type { MapPlace } from "@/map/floor/floor";

const NO_PLACES: readonly MapPlace[] = [];

/** A step's title and icon for lists: "1 × box to Painting Machine". */
export function useStepWords(
  document: ProgramDocument,
  devices: readonly SiteDevice[],
  places: readonly MapPlace[] = NO_PLACES,
) {
  const t = useEditorText();
  return useMemo(() => {
    const speaker = { t, document, surroundings: surroundingsOf(devices, places) };
    const titleOf = (id: string): string => {
      const step = document.steps[id];
      if (!step) return "";
      // On the map a choice is a diamond with a sign in it; in a list its word is read.
      const text = step.kind === "if" ? t("kind.if") : plainText(chipText(step, speaker));
      if (step.kind === "pick_and_drop") {
        const target = placeName(step.params.target as Parameters<typeof placeName>[0], speaker);
        return `${text} → ${target ?? "?"}`;
      }
      const condition = step.kind === "if" || step.kind === "while" ? plainText(conditionText(step, speaker)) : "";
      return condition ? `${text} ${condition}` : text;
    };
    const iconOf = (id: string): string => kindOf(document.steps[id]?.kind ?? "").icon;
    return { titleOf, iconOf };
  }, [t, document, devices, places]);
}
