/** The languages of the screens: each file of a language is one area, `t("area.key")`. */
import i18next from "i18next";
import { initReactI18next } from "react-i18next";

export const LANGUAGES = ["en", "de"] as const;
export type Language = (typeof LANGUAGES)[number];

const KEPT_AS = "vipo.language";
const files = import.meta.glob<Record<string, unknown>>("./{en,de}/*.json", { eager: true, import: "default" });

/** `{en: {shell: …}, de: …}` out of `./en/shell.json` and so on. */
export function gatherAreas(sources: Record<string, Record<string, unknown>>): Record<string, Record<string, unknown>> {
  const gathered: Record<string, Record<string, unknown>> = {};
  for (const [path, texts] of Object.entries(sources)) {
    const [, language = "", area = ""] = /\/(\w+)\/(\w+)\.json$/.exec(path) ?? [];
    gathered[language] = { ...gathered[language], [area]: texts };
  }
  return gathered;
}

function firstLanguage(): Language {
  const wanted = [localStorage.getItem(KEPT_AS), ...navigator.languages.map((each) => each.slice(0, 2))];
  return wanted.find((each): each is Language => LANGUAGES.includes(each as Language)) ?? "en";
}

/** Choose a language and keep the choice in this browser. */
export function chooseLanguage(language: Language): void {
  localStorage.setItem(KEPT_AS, language);
  void i18next.changeLanguage(language);
}

/** Ready when this returns: the catalogues are part of the page. */
export function startI18n(): void {
  const areas = gatherAreas(files);
  i18next.on("languageChanged", (language) => document.documentElement.setAttribute("lang", language));
  void i18next.use(initReactI18next).init({
    resources: Object.fromEntries(Object.entries(areas).map(([language, texts]) => [language, { translation: texts }])),
    lng: firstLanguage(),
    fallbackLng: "en",
    interpolation: { escapeValue: false },
    initAsync: false,
  });
}
