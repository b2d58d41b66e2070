/** A setting of a site, below one address of its API: read, and set by admins. */
import { notifications } from "@mantine/notifications";
import { type QueryKey, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import { problemText } from "@/shell/LoadProblem";

const addressOf = (slug: string, path: string) => `/sites/${encodeURIComponent(slug)}/${path}`;

export const useSetting = <Held>(slug: string, path: string, isWanted: boolean) =>
  useQuery({
    queryKey: keys.setting(slug, path),
    queryFn: () => api.get<Held>(addressOf(slug, path)),
    enabled: isWanted,
  });

interface Setting {
  slug: string;
  path: string;
  /** What is told once it is set. */
  saved: string;
  /** What follows from it and is asked for anew then. */
  touches?: QueryKey;
}

/** Set it; people are told that it was, or why not. */
export function useSetSetting<Held, Chosen = Held>({ slug, path, saved, touches }: Setting) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (chosen: Chosen) => api.put<Held>(addressOf(slug, path), chosen),
    onSuccess: (held) => {
      queries.setQueryData(keys.setting(slug, path), held);
      notifications.show({ message: saved });
      return touches && queries.invalidateQueries({ queryKey: touches });
    },
    onError: (error) => notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")) }),
  });
}
