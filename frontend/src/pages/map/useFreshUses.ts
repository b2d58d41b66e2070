/** Who is shown what a change concerns sees the programs and runs that there are now, not those of a while ago. */
import { useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { keys } from "@/api/queries";

/** Fetch the programs and runs of a site anew when the caller is shown; no news tells where programs go by now. */
export function useFreshUses(slug: string): void {
  const queries = useQueryClient();
  useEffect(() => {
    for (const queryKey of [keys.programs(slug), keys.runs(slug)]) void queries.invalidateQueries({ queryKey });
  }, [queries, slug]);
}
