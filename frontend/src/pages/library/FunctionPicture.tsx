/** A function where it happens: its machines and paths on the site's map. */
import { skipToken, useQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { api } from "@/api/client";
import { useDevices, useSiteMap } from "@/api/queries";
import type { LibraryFunction, RouteAnswer } from "@/api/types";
import { StaticMap } from "@/map/StaticMap";
import { devicesIn, focusOn, pathsIn } from "./picture";

function useWays(slug: string, definition: LibraryFunction["definition"]) {
  const pairs = useMemo(() => pathsIn(definition), [definition]);
  return useQuery({
    queryKey: ["paths", slug, pairs],
    queryFn: pairs.length > 0 ? () => api.post<(RouteAnswer | null)[]>(`/sites/${slug}/routes`, { pairs }) : skipToken,
    staleTime: Infinity,
    retry: false,
  });
}

export function FunctionPicture({ slug, item }: { slug: string; item: LibraryFunction }) {
  const map = useSiteMap(slug).data ?? null;
  const devices = useDevices(slug).data ?? [];
  const answers = useWays(slug, item.definition).data;
  const paths = (answers ?? []).flatMap((answer) => (answer ? [answer.path] : []));
  const used = devicesIn(item.definition);
  const shown = devices.filter((device) => used.includes(device.id));
  const focus = focusOn(shown, paths);
  return <StaticMap plan={map} devices={shown} routes={paths} focus={focus} label={item.name} />;
}
