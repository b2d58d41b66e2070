/** The languages of the screens; the texts of one are loaded when it is chosen, those of most screens with the first. */
import i18next from "i18next";
import { initReactI18next } from "react-i18next";
import { type Areas, gatherAreas } from "./areas";

export const LANGUAGES = ["en", "de"] as const;
export type Language = (typeof LANGUAGES)[number];

const KEPT_AS = "vipo.language";
type Catalogue = Record<Language, () => Promise<{ texts: Areas }>>;
type Part = "base" | "screens";
/** What the editor and all bars say, and what the other screens say. */
const CATALOGUES: Record<Part, Catalogue> = {
  base: { en: () => import("./catalogue.en"), de: () => import("./catalogue.de") },
  screens: { en: () => import("./catalogue.screens.en"), de: () => import("./catalogue.screens.de") },
};
const wanted = new Set<Part>(["base"]);
let started: Promise<void> | null = null;

/** Done when a part of the texts of a language is there, beside what is there of it already. */
export async function addTexts(language: Language, part: Part): Promise<void> {
  const [{ texts }] = await Promise.all([CATALOGUES[part][language](), startI18n()]);
  i18next.addResourceBundle(language, "translation", gatherAreas(texts), true, true);
}

/** Done when the screens beside the editor have their texts, in the language that is spoken now. */
export async function loadScreenTexts(): Promise<void> {
  wanted.add("screens");
  await addTexts((i18next.language as Language | undefined) ?? firstLanguage(), "screens");
}

function firstLanguage(): Language {
  const wanted = [localStorage.getItem(KEPT_AS), ...navigator.languages.map((each) => each.slice(0, 2))];
  return wanted.find((each): each is Language => LANGUAGES.includes(each as Language)) ?? "en";
}

/** Choose a language and keep the choice in this browser; a page that is older than the server begins anew with it. */
export async function chooseLanguage(language: Language): Promise<void> {
  localStorage.setItem(KEPT_AS, language);
  try {
    await Promise.all([...wanted].map((part) => addTexts(language, part)));
    await i18next.changeLanguage(language);
  } catch {
    location.reload();
  }
}

/** Done when there are texts. */
export function startI18n(): Promise<void> {
  started ??= start();
  return started;
}

async function start(): Promise<void> {
  const language = firstLanguage();
  const { texts } = await CATALOGUES.base[language]();
  i18next.on("languageChanged", (chosen) => document.documentElement.setAttribute("lang", chosen));
  await i18next.use(initReactI18next).init({
    resources: { [language]: { translation: gatherAreas(texts) } },
    lng: language,
    // Each language has every text: a test holds that.
    fallbackLng: false,
    interpolation: { escapeValue: false },
  });
}
