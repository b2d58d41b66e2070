/** Steps where they happen: their machines and paths on the site's map. */
import { skipToken, useQuery } from "@tanstack/react-query";
import { Globe } from "lucide-react";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { useDevices, useSiteMap, useSites } from "@/api/queries";
import type { LibraryFunction, RouteAnswer } from "@/api/types";
import { floorMark } from "@/map/floor/floor";
import { StaticMap } from "@/map/StaticMap";
import styles from "./library.module.css";
import { devicesIn, type Drawn, focusOn, pathsIn } from "./picture";

function useWays(slug: string, floor: string | undefined, definition: Drawn) {
  const pairs = useMemo(() => pathsIn(definition), [definition]);
  return useQuery({
    queryKey: ["paths", slug, floor, pairs],
    queryFn: pairs.length > 0 ? () => api.post<(RouteAnswer | null)[]>(`/sites/${slug}/routes`, { pairs }) : skipToken,
    staleTime: Infinity,
    retry: false,
  });
}

/** A function on the map of the site that it comes from; people who are no members there have no map to see. */
export function FunctionPicture({ item }: { item: LibraryFunction }) {
  const { t } = useTranslation();
  const sites = useSites().data;
  if (!sites) return null;
  if (sites.some((site) => site.slug === item.site))
    return <StepsPicture slug={item.site} drawn={item.definition} label={item.name} />;
  return (
    <div className={styles.noMap}>
      <Globe size={20} aria-hidden="true" />
      <span>{t("library.noMap")}</span>
    </div>
  );
}

/** `whole` shows all of the map instead of the part where the steps are. */
export function StepsPicture(props: { slug: string; drawn: Drawn; label: string; whole?: boolean }) {
  const { slug, drawn, label, whole } = props;
  const map = useSiteMap(slug).data ?? null;
  const devices = useDevices(slug).data ?? [];
  const answers = useWays(slug, floorMark(map), drawn).data;
  const paths = (answers ?? []).flatMap((answer) => (answer ? [answer.path] : []));
  const used = devicesIn(drawn);
  const shown = devices.filter((device) => used.includes(device.id));
  const focus = whole ? undefined : focusOn(shown, paths);
  return <StaticMap plan={map} devices={shown} routes={paths} focus={focus} label={label} />;
}
