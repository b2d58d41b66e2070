/** What a device is doing, in the language of the screen; what it says itself stays as it is, in quotes. */
import i18next from "i18next";
import { formatNumber } from "./format";

interface Doer {
  readonly doing: string;
  /** What it is doing, by a code; null where it says so only in its own words. */
  readonly activity?: { readonly code: string; readonly args: Readonly<Record<string, unknown>> } | null;
  /** It is simulated in place of the real one. */
  readonly stand_in?: boolean;
}

/** `2 boxes`; in other languages `2 × box`, for objects are called as the site calls them. */
export function countedWords(count: number, name: string): string {
  if (!i18next.language.startsWith("en")) return `${formatNumber(count)} × ${name}`;
  if (count === 1) return `1 ${name}`;
  return `${formatNumber(count)} ${name}${/(x|s|ch|sh)$/.test(name) ? "es" : "s"}`;
}

/** What was told of a state of a device, which is never changed: maps ask in each frame. */
const told = new WeakMap<Doer, { readonly language: string; readonly words: string }>();

/** Empty where there is nothing to tell; of what is simulated in place of a real one it says so. */
export function activityWords(doer: Doer): string {
  const { language } = i18next;
  const before = told.get(doer);
  if (before && before.language === language) return before.words;
  const words = wordsOf(doer);
  told.set(doer, { language, words });
  return words;
}

function wordsOf(doer: Doer): string {
  const words = doingWords(doer);
  if (!doer.stand_in) return words;
  const isIdle = !words || doer.activity?.code === "ready";
  return isIdle ? i18next.t("device.standIn.mark") : i18next.t("device.standIn.doing", { doing: words });
}

/** What it does, without that; the server's own words where the screens do not know the code. */
export function doingWords({ doing, activity }: Doer): string {
  if (!activity) return doing;
  const { args } = activity;
  const count = typeof args.count === "number" ? args.count : undefined;
  if (!i18next.exists(`device.doing.${activity.code}`, { count })) return doing;
  const load = Object.entries(args).map(([name, count]) => countedWords(Number(count), name));
  return i18next.t(`device.doing.${activity.code}`, {
    ...args,
    load: load.join(", "),
    stock: countedWords(Number(args.count), String(args.object)),
  });
}
