/** What a field wants, with the names that its step can use and the words of the screen's language. */
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { useStepEditor } from "../fields/stepEditor";
import type { Wanted } from "./literal";

const NO_OPTIONS: readonly unknown[] = [];

export function useWanted(type: string | undefined, options: readonly unknown[] | null | undefined): Wanted {
  const { t, i18n } = useTranslation();
  const { parameters } = useStepEditor();
  const given = options ?? NO_OPTIONS;
  const listed = given.length > 0 ? JSON.stringify(given) : "[]";
  return useMemo<Wanted>(
    () => ({
      type,
      options: (JSON.parse(listed) as unknown[]).filter(isScalar),
      names: new Set(parameters.map((each) => each.name)),
      yes: t("editor.value.true"),
      no: t("editor.value.false"),
      comma: i18n.language.startsWith("de"),
    }),
    [type, listed, parameters, t, i18n.language],
  );
}

function isScalar(value: unknown): value is string | number | boolean {
  return ["string", "number", "boolean"].includes(typeof value);
}
