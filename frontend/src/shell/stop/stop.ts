/** Pressing and resetting the stop of a site. */
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import { problemText } from "../LoadProblem";

export function useStopAll(slug: string) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const refresh = () => queries.invalidateQueries({ queryKey: keys.site(slug) });
  const refused = (error: unknown) =>
    notifications.show({
      color: "red",
      title: t("shell.stop.notHeard"),
      message: `${problemText(error, "")} ${t("shell.stop.useHardware")}`.trim(),
      autoClose: false,
    });
  const press = useMutation({
    mutationFn: () => api.post(`/sites/${slug}/stop`),
    onSuccess: refresh,
    onError: refused,
  });
  const reset = useMutation({
    mutationFn: () => api.post(`/sites/${slug}/stop/reset`),
    onSuccess: refresh,
    onError: refused,
  });
  return { press, reset };
}

/** Ctrl+Shift+. (Cmd on a Mac) from wherever the focus is. */
export function useStopKey(press: () => void): void {
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const held = (event.ctrlKey || event.metaKey) && event.shiftKey;
      // Where the full stop is another key, either of the two stops: better once too often than not at all.
      if (!held || !(event.code === "Period" || event.key === ".") || event.repeat) return;
      event.preventDefault();
      press();
    };
    window.addEventListener("keydown", onKey, { capture: true });
    return () => window.removeEventListener("keydown", onKey, { capture: true });
  }, [press]);
}
