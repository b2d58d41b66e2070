/** What every page offers in the palette: pages, programs, devices, places, runs, functions, how the screen looks. */
import {
  Activity,
  CircleUserRound,
  Cpu,
  History,
  House,
  Languages,
  Library,
  Map,
  MapPin,
  Moon,
  SquareFunction,
  Sun,
  Users,
  Workflow,
  type LucideIcon,
} from "lucide-react";
import { useDebouncedValue } from "@mantine/hooks";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { useDevices, useLibrary, usePrograms, useSite, useSiteMap } from "@/api/queries";
import { useRuns } from "@/api/runs";
import type { LibraryFunction } from "@/api/types";
import { chooseLanguage, LANGUAGES } from "@/i18n";
import { seesOperations } from "../findings/findings";
import { chooseTheme } from "../theme";
import { useOffers } from "./offers";
import type { Target, TargetKind } from "./search";

const PAGES: readonly [string, LucideIcon][] = [
  ["programs", Workflow],
  ["devices", Cpu],
  ["library", Library],
  ["runs", History],
  ["map", Map],
];
const RUNS = 20;
const TYPING_MS = 200;

type Words = (key: string) => string;

/** All that can be found on this page by what is typed; `other` reads the language that is not chosen. */
export function useTargets(slug: string | undefined, other: Words, query: string): readonly Target[] {
  const offer = useOffers((state) => state.offer);
  const pages = usePageTargets(slug, other);
  const things = useThingTargets(slug, query);
  return useMemo(() => [...(offer?.targets(other) ?? []), ...things, ...pages], [offer, other, things, pages]);
}

function usePageTargets(slug: string | undefined, other: Words): readonly Target[] {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const role = useSite(slug).data?.role;
  return useMemo(() => {
    const page = (key: string, icon: LucideIcon, to: string): Target => ({
      id: `page:${to}`,
      kind: "page",
      name: t(key),
      also: other(key),
      icon,
      run: () => void navigate(to),
    });
    const pages = seesOperations(role) ? [...PAGES, ["operations", Activity] as const] : PAGES;
    return [
      page("shell.nav.home", House, "/"),
      ...(slug ? pages.map(([name, icon]) => page(`shell.nav.${name}`, icon, `/sites/${slug}/${name}`)) : []),
      ...(slug ? [page("shell.nav.people", Users, `/sites/${slug}/people`)] : []),
      page("shell.account.settings", CircleUserRound, "/account"),
      ...lookTargets(t, other),
    ];
  }, [t, other, navigate, role, slug]);
}

/** Light, dark, and the languages. */
function lookTargets(t: Words, other: Words): Target[] {
  const themes = [
    ["light", Sun],
    ["dark", Moon],
  ] as const;
  return [
    ...themes.map(([theme, icon]): Target => ({
      id: `theme:${theme}`,
      kind: "command",
      name: t(`shell.jump.theme_${theme}`),
      also: other(`shell.jump.theme_${theme}`),
      icon,
      run: () => chooseTheme(theme),
    })),
    ...LANGUAGES.map((language): Target => ({
      id: `language:${language}`,
      kind: "command",
      name: t(`shell.language.${language}`),
      also: `${t("shell.jump.language")} ${other("shell.jump.language")}`,
      icon: Languages,
      run: () => void chooseLanguage(language),
    })),
  ];
}

/** The first functions of the library, and those that have the words: a long library is not read for a jump. */
function useFunctions(slug: string | undefined, query: string): readonly LibraryFunction[] {
  const [words] = useDebouncedValue(query.trim(), TYPING_MS);
  const first = useLibrary("", slug).data;
  const found = useLibrary(words, slug).data;
  return useMemo(() => {
    const known = new Set((first ?? []).map(({ id }) => id));
    return [...(first ?? []), ...(found ?? []).filter(({ id }) => !known.has(id))];
  }, [first, found]);
}

/** What there is at the site. */
function useThingTargets(slug: string | undefined, query: string): readonly Target[] {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const programs = usePrograms(slug).data;
  const devices = useDevices(slug).data;
  const runs = useRuns(slug).data;
  const site = useSite(slug).data;
  const places = useSiteMap(site?.has_map ? slug : undefined).data?.places;
  const functions = useFunctions(slug, query);
  return useMemo(() => {
    const thing = (kind: TargetKind, icon: LucideIcon, to: string, name: string, also = ""): Target => {
      return { id: `${kind}:${to}`, kind, icon, name, also, run: () => void navigate(to) };
    };
    const at = `/sites/${slug ?? ""}`;
    const run = (number: number, program: string) => t("shell.jump.run_of", { number, program });
    return [
      ...(programs ?? []).map((each) => thing("program", Workflow, `/programs/${each.id}`, each.name)),
      ...(devices ?? []).map((each) => thing("device", Cpu, `${at}/devices/${each.id}`, each.name, each.id)),
      ...(places ?? []).map((each) => thing("place", MapPin, `${at}/map?place=${each.id}`, each.name, each.id)),
      ...(functions ?? []).map((each) =>
        thing("function", SquareFunction, `${at}/library/${each.id}`, each.name, each.description),
      ),
      ...(runs ?? [])
        .slice(0, RUNS)
        .map((each) => thing("run", History, `/runs/${each.id}`, run(each.number, each.program.name))),
    ];
  }, [t, navigate, slug, programs, devices, places, functions, runs]);
}
