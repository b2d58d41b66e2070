/** A setting of a site, below one address of its API: read, and set by admins. */
import { notifications } from "@mantine/notifications";
import { type QueryKey, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
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

/**
 * The fields of a setting as they are held, with what somebody has touched here on top: what others set meanwhile is
 * seen, and only what was touched is sent. `settle` lets go of what has been saved as it is.
 */
export function useTouched<Fields extends object>(held: Fields) {
  const [touched, setTouched] = useState<Partial<Fields>>({});
  return {
    fields: { ...held, ...touched },
    touched,
    touch: (some: Partial<Fields>) => setTouched((now) => ({ ...now, ...some })),
    settle: (sent: Partial<Fields>) => setTouched((now) => without(now, sent)),
  };
}

/** The fields that are not as they were sent. */
function without<Fields extends object>(now: Partial<Fields>, sent: Partial<Fields>): Partial<Fields> {
  const names = (Object.keys(now) as (keyof Fields)[]).filter((name) => now[name] !== sent[name]);
  return Object.fromEntries(names.map((name) => [name, now[name]])) as Partial<Fields>;
}

interface Setting {
  slug: string;
  path: string;
  /** What is told once it is set. */
  saved: string;
  /** What follows from it and is asked for anew then. */
  touches?: QueryKey;
}

/** Set what was touched of it; the rest stays as the server holds it. People are told that it was set, or why not. */
export function useSetSetting<Held, Chosen>({ slug, path, saved, touches }: Setting) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (touched: Partial<Chosen>) => api.put<Held>(addressOf(slug, path), touched),
    onSuccess: (held) => {
      queries.setQueryData(keys.setting(slug, path), held);
      notifications.show({ message: saved });
      return touches && queries.invalidateQueries({ queryKey: touches });
    },
    onError: (error) => notifications.show({ color: "red", message: problemText(error, t("shell.problem.screen")) }),
  });
}
