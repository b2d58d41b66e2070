/** The site that the side bar is about: the address's, else the one that was last looked at, else the first. */
import { useEffect } from "react";
import { useParams } from "react-router-dom";
import { useSite, useSites } from "@/api/queries";
import type { Site } from "@/api/types";
import { useLiveStore } from "@/live/store";

const KEPT_AS = "vipo.site";

/** Let the side bar be about a site from now on. */
export function keepSite(slug: string): void {
  localStorage.setItem(KEPT_AS, slug);
}

interface CurrentSite {
  slug: string | undefined;
  /** The same, for what asks about the site: undefined once this person was told that they are no member any more. */
  open: string | undefined;
  site: Site | undefined;
  sites: Site[];
}

export function useCurrentSite(): CurrentSite {
  const named = useParams().slug;
  const sites = useSites().data ?? [];
  const kept = localStorage.getItem(KEPT_AS);
  const slug = named ?? (sites.find((each) => each.slug === kept) ?? sites[0])?.slug;
  const site = useSite(slug).data ?? sites.find((each) => each.slug === slug);
  const isClosed = useLiveStore((state) => state.connection === "refused" && state.site === named);
  useEffect(() => {
    if (slug) keepSite(slug);
  }, [slug]);
  return { slug, open: isClosed ? undefined : slug, site, sites };
}
