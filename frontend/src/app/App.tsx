/** Everything that every screen needs around it. */
import { MantineProvider } from "@mantine/core";
import { QueryClientProvider } from "@tanstack/react-query";
import { lazy, Suspense, useEffect, useMemo, useSyncExternalStore } from "react";
import { useTranslation } from "react-i18next";
import { matchPath, RouterProvider } from "react-router-dom";
import { makeQueryClient, ME } from "@/api/queries";
import { makeTheme, variablesResolver } from "@/design/theme";
import { watchAhead } from "@/live/site";
import { forgetOthers } from "./onlyOwn";
import { makeRouter } from "./router";
import { Waiting } from "@/shell/LoadProblem";
import { useTheme } from "@/shell/theme";
import { useKeepOnlyOwn } from "@/shell/waitingCopies";

// Outside of the tree: state of a tree that suspends before its first commit is thrown away.
const queries = makeQueryClient();
forgetOthers(queries);
void queries.prefetchQuery(ME);
const slugAhead = matchPath("/sites/:slug/*", location.pathname)?.params.slug;
if (slugAhead && slugAhead !== "new") watchAhead(slugAhead, queries);
const router = makeRouter();

/** What is told before they are there waits in their store. */
const Notices = lazy(async () => {
  for (;;) {
    const found = await import("./Notices").catch(() => null); // a page without messages is better than none
    if (found) return { default: found.Notices };
    await new Promise((done) => setTimeout(done, AGAIN_MS));
  }
});
const AGAIN_MS = 3000;

export function App() {
  const { t } = useTranslation();
  const scheme = useTheme();
  const [close, showPassword] = [t("pages.close"), t("pages.showPassword")];
  const theme = useMemo(() => makeTheme({ close, showPassword }), [close, showPassword]);
  useEffect(() => document.documentElement.setAttribute("data-theme", scheme), [scheme]);
  return (
    <QueryClientProvider client={queries}>
      <MantineProvider theme={theme} cssVariablesResolver={variablesResolver} forceColorScheme={scheme}>
        <Suspense fallback={null}>
          <Notices />
        </Suspense>
        <KeepOnlyOwn />
        <Screens />
      </MantineProvider>
    </QueryClientProvider>
  );
}

/** The router's own component would miss a screen that is there between its first picture and its first effect. */
function Screens() {
  const isReady = useSyncExternalStore(
    (hear) => router.subscribe(hear),
    () => router.state.initialized,
  );
  return isReady ? <RouterProvider router={router} /> : <Waiting />;
}

function KeepOnlyOwn() {
  useKeepOnlyOwn();
  return null;
}
