/** Stop all: acts at once, holds for everybody, says who pressed it. Needed in every bar of a site. */
import { Tooltip } from "@mantine/core";
import { OctagonX } from "lucide-react";
import { lazy, Suspense, useCallback, useState } from "react";
import { useTranslation } from "react-i18next";
import { useSite } from "@/api/queries";
import { useFetchLater } from "@/design/useFetchLater";
import { useLiveStore } from "@/live/store";
import { useStopAll, useStopKey } from "./stop";
import styles from "./stop.module.css";

const loadDialog = () => import("./StopDialog");
const LOADS = [loadDialog];
const StopDialog = lazy(async () => ({ default: (await loadDialog()).StopDialog }));

export function StopAllButton({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const site = useSite(slug).data;
  const { press, reset } = useStopAll(slug);
  const active = site?.stop.active ?? false;
  const at = site?.stop.at ?? "";
  const [closedAt, setClosedAt] = useState<string | null>(null);
  const send = press.mutate;
  // While the news are away nobody knows whether the site is still stopped: better once too often than not at all.
  const isKnown = useLiveStore((state) => state.site === slug && state.connection === "live");
  const pressStop = useCallback(() => {
    if (active) setClosedAt(null);
    if (!active || !isKnown) send();
  }, [active, isKnown, send]);
  useStopKey(pressStop);
  useFetchLater(LOADS);
  const [shown, setShown] = useState(false);
  // Once it was open it stays, so that it is seen to close.
  if (active && !shown) setShown(true);
  return (
    <>
      <Tooltip label={active ? t("shell.stop.showWhy") : t("shell.stop.hint")}>
        <button
          type="button"
          className={styles.stop}
          data-active={active || undefined}
          aria-keyshortcuts="Control+Shift+."
          onClick={pressStop}
        >
          <OctagonX size={16} strokeWidth={2.2} aria-hidden="true" />
          <span>{active ? t("shell.stop.stopped") : t("shell.stop.all")}</span>
        </button>
      </Tooltip>
      <span className="visually-hidden" role="alert">
        {active ? t("shell.stop.pressed", { who: site?.stop.by ?? t("shell.stop.somebody") }) : ""}
      </span>
      {site && shown ? (
        <Suspense fallback={null}>
          <StopDialog
            site={site}
            opened={active && closedAt !== at}
            busy={reset.isPending}
            onReset={() => reset.mutate()}
            onClose={() => setClosedAt(at)}
          />
        </Suspense>
      ) : null}
    </>
  );
}
