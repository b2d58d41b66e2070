/** What a construct is called in lists: its number, its icon and its words, from the side where it is. */
import { useCallback } from "react";
import { useTranslation } from "react-i18next";
import type { ConstructChange } from "@/api/types";
import { kindOf } from "@/program/kinds";
import type { Place } from "@/program/document/document";
import { chipText, conditionText, placeName, plainText } from "@/program/words/stepWords";
import { otherName } from "./fieldWords";
import type { Pictures } from "./usePictures";

export interface ConstructWords {
  readonly number: string;
  readonly icon: string | null;
  readonly title: string;
}

export function useConstructWords(
  pictures: Pictures,
): (change: Pick<ConstructChange, "root" | "id">) => ConstructWords {
  const { t } = useTranslation();
  const { old, new: next } = pictures;
  return useCallback(
    ({ root, id }) => {
      if (root !== "steps") {
        const name = otherName({ root, id }, [next.document, old.document]);
        return { number: "", icon: null, title: t(`compare.root.${root}`, { name }) };
      }
      const side = Object.hasOwn(next.document.steps, id) ? next : old;
      const step = side.document.steps[id];
      if (!step) return { number: "", icon: null, title: id };
      const speaker = { document: side.document, surroundings: side.surroundings, t: side.t };
      const said = plainText(chipText(step, speaker));
      const target = step.kind === "pick_and_drop" ? placeName(step.params.target as Place, speaker) : null;
      const condition = step.kind === "if" || step.kind === "while" ? plainText(conditionText(step, speaker)) : "";
      const whole = target ? `${said} → ${target}` : `${said} ${condition}`.trim();
      const title = step.kind === "comment" ? `${side.t("kind.comment")}: ${whole}` : whole;
      return { number: side.compiled?.numbers[id] ?? "", icon: kindOf(step.kind).icon, title };
    },
    [old, next, t],
  );
}
