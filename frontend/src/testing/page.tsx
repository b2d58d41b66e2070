import { MantineProvider } from "@mantine/core";
import { notifications, Notifications } from "@mantine/notifications";
import { QueryClientProvider, type QueryClient } from "@tanstack/react-query";
import { cleanup, render, type RenderResult } from "@testing-library/react";
import type { ReactNode } from "react";
import { createMemoryRouter, MemoryRouter, RouterProvider, type RouteObject } from "react-router-dom";
import { afterEach, beforeAll, vi } from "vitest";
import { makeQueryClient } from "@/api/queries";
import { loadScreenTexts, startI18n } from "@/i18n";
import { forgetLive } from "@/live/site";

/** Tests of this file read all texts of the screens, and leave no page, line to a site, stubbed global nor anything told. */
export function testsPages(): void {
  beforeAll(async () => {
    await startI18n();
    await loadScreenTexts();
  });
  afterEach(() => {
    cleanup();
    forgetLive(false);
    notifications.clean();
    vi.unstubAllGlobals();
  });
}

function inside(queries: QueryClient, what: ReactNode): ReactNode {
  return (
    <QueryClientProvider client={queries}>
      <MantineProvider env="test">{what}</MantineProvider>
    </QueryClientProvider>
  );
}

/** What an element of a page shows that stands at no address of its own. */
export function show(what: ReactNode, queries: QueryClient = makeQueryClient()): RenderResult {
  return render(inside(queries, <MemoryRouter>{what}</MemoryRouter>));
}

/** The same with the corner where refusals are told, which stays when people `leave` the element. */
export function showWithCorner(what: ReactNode, queries: QueryClient = makeQueryClient()) {
  const page = (shown: ReactNode) =>
    inside(
      queries,
      <MemoryRouter>
        <Notifications />
        {shown}
      </MemoryRouter>,
    );
  const { rerender } = render(page(what));
  return { leave: () => rerender(page(null)) };
}

/** What a page shows at an address; `go` leads to another one. */
export function showAt(address: string, routes: RouteObject[], queries: QueryClient = makeQueryClient()) {
  const router = createMemoryRouter(routes, { initialEntries: [address] });
  render(inside(queries, <RouterProvider router={router} />));
  return { queries, go: (to: string) => router.navigate(to) };
}
