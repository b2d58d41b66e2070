/**
 * Which address shows which screen. A screen is loaded when it is first needed, before it is shown: behind a Suspense
 * React would wait for 300 ms more.
 */
import type { ComponentType } from "react";
import { createBrowserRouter, useParams, type RouteObject } from "react-router-dom";
import { loadScreenTexts } from "@/i18n";
import { SETTINGS } from "@/shell/settings";
import { SETTINGS_PAGES } from "@/pages/settings/settingsPages";
import { RequireUser } from "./RequireUser";
import { RouteProblem } from "./RouteProblem";

type Screens = Record<string, () => Promise<Record<string, ComponentType>>>;

const screens: Screens = import.meta.glob<Record<string, ComponentType>>([
  "../pages/*/*Page.tsx",
  "../editor/EditorScreen.tsx",
  "../compare/CompareScreen.tsx",
  "../compare/functions/FunctionCompareScreen.tsx",
  "../run/RunScreen.tsx",
  "../simulation/SimulationScreen.tsx",
]);

/** The one screen that has all of its texts from the start, so that drawing begins soon. */
const EDITOR = "editor/EditorScreen";
const ROUTES: readonly [path: string, file: string][] = [
  ["/", "pages/home/HomePage"],
  ["/account", "pages/account/AccountPage"],
  ["/sites/new", "pages/site/NewSitePage"],
  ["/sites/:slug", "pages/home/SiteHomePage"],
  ["/sites/:slug/devices/:id?", "pages/devices/DevicesPage"],
  ["/sites/:slug/programs", "pages/programs/ProgramsPage"],
  ["/sites/:slug/library/:id?", "pages/library/LibraryPage"],
  ["/sites/:slug/library/:id/compare", "compare/functions/FunctionCompareScreen"],
  ["/sites/:slug/runs", "pages/runs/RunsPage"],
  ["/sites/:slug/map", "pages/map/MapPage"],
  ["/sites/:slug/map/new", "pages/site/NewMapPage"],
  ["/sites/:slug/map/edit", "pages/mapEdit/MapEditPage"],
  ["/sites/:slug/operations", "pages/operations/OperationsPage"],
  ["/programs/:id", EDITOR],
  ["/programs/:id/compare", "compare/CompareScreen"],
  ["/sites/:slug/history/:id", "pages/history/HistoryPage"],
  ["/programs/:id/simulate/:rehearsal?", "simulation/SimulationScreen"],
  ["/runs/:id", "run/RunScreen"],
];

/** The route of a screen; none while the screen's file does not exist. */
function route(path: string, file: string): RouteObject[] {
  const load = screens[`../${file}.tsx`];
  const name = file.slice(file.lastIndexOf("/") + 1);
  if (!load) return [];
  const lazy = async () => {
    const [module] = await Promise.all([load(), file === EDITOR ? null : loadScreenTexts()]);
    const screen = pick(module, name);
    return { Component: /\/(programs|runs|history)\/:id/.test(path) ? whereIdIs(screen) : screen };
  };
  return [{ path, lazy }];
}

/** Each marks Settings in the side bar. */
const settings = SETTINGS_PAGES.flatMap(({ path, file }) =>
  route(`/sites/:slug/${path}`, file).map((page): RouteObject => ({ ...page, handle: SETTINGS })),
);

/** A screen of a program or run: not at an address that was cut off or mistyped, which none of them has. */
function whereIdIs(Screen: ComponentType): ComponentType {
  return function ScreenOfId() {
    const isId = /^[\da-f]{8}(-[\da-f]{4}){3}-[\da-f]{12}$/i.test(useParams().id ?? "");
    return isId ? <Screen /> : <RouteProblem />;
  };
}

function pick(module: Record<string, ComponentType>, name: string): ComponentType {
  const screen = module[name];
  if (!screen) throw new Error(`The module of ${name} does not export it.`);
  return screen;
}

export function makeRouter() {
  const router = createBrowserRouter([
    {
      errorElement: <RouteProblem />,
      children: [
        ...route("/sign-in", "pages/signin/SignInPage"),
        ...route("/sign-on/:provider", "pages/signin/SignOnPage"),
        ...route("/invitation", "pages/invitation/InvitationPage"),
        ...route("/wall", "pages/wall/WallPage"),
      ],
    },
    {
      element: <RequireUser />,
      errorElement: <RouteProblem />,
      children: [
        ...ROUTES.flatMap(([path, file]) => route(path, file)),
        ...settings,
        { path: "*", element: <RouteProblem /> },
      ],
    },
  ]);
  // A line at the top of the page while the next screen is on its way; see global.css.
  router.subscribe(({ navigation }) =>
    document.documentElement.toggleAttribute("data-arriving", !!navigation.location),
  );
  return router;
}
