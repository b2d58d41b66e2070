/** The texts of the language that is not chosen: people look for things by the words that they know. */
import { useQuery } from "@tanstack/react-query";
import i18next from "i18next";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { addTexts, LANGUAGES } from ".";

const NOTHING = () => "";

/** Reads a text of the other language; an empty one until its catalogue has come, or where it cannot be had. */
export function useOtherLanguage(): (key: string) => string {
  const { language } = useTranslation().i18n;
  const other = LANGUAGES.find((each) => each !== language) ?? "en";
  const loaded = useQuery({
    queryKey: ["catalogue", other],
    queryFn: async () => {
      await addTexts(other, "base");
      return true;
    },
    staleTime: Infinity,
    retry: false,
  }).isSuccess;
  return useMemo(() => {
    const t = i18next.getFixedT(other);
    return loaded ? (key: string) => t(key) : NOTHING;
  }, [loaded, other]);
}
