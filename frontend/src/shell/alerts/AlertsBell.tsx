/** How many alerts nobody has seen, how bad the worst is, and the list of them; new errors are read aloud. */
import { Popover } from "@mantine/core";
import { Bell } from "lucide-react";
import { lazy, Suspense, useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { useDevices } from "@/api/queries";
import type { Alert } from "@/api/types";
import { StatusGlyph } from "@/design/StatusGlyph";
import { loadScreenTexts } from "@/i18n";
import { freshErrors, inState, knownOf, worstOf, type Known } from "./alerts";
import styles from "./alerts.module.css";
import { useAlerts } from "./useAlerts";
import { alertWords, ownWords, signOf } from "./alertWords";

/** Loaded when it is opened, with the words of what devices do wrong. */
const AlertList = lazy(async () => {
  const [{ AlertList: list }] = await Promise.all([import("./AlertList"), loadScreenTexts()]);
  return { default: list };
});
const MOST_SHOWN = 99;

/** What is new among the errors, in words; it stays until the next. */
function useAnnouncement(slug: string, alerts: readonly Alert[], isKnown: boolean): string {
  const devices = useDevices(slug).data;
  const known = useRef<Known | null>(null);
  const [said, setSaid] = useState("");
  useEffect(() => {
    if (!isKnown) return;
    const fresh = freshErrors(known.current, alerts);
    known.current = knownOf(alerts);
    if (fresh.length === 0) return;
    const nameOf = (id: string) => devices?.find((device) => device.id === id)?.name ?? id;
    setSaid(fresh.map((each) => [nameOf(each.device), alertWords(each), ownWords(each)].join(": ")).join(". "));
  }, [alerts, devices, isKnown]);
  return said;
}

export function AlertsBell({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const [opened, setOpened] = useState(false);
  const { alerts, query } = useAlerts(slug);
  const said = useAnnouncement(slug, alerts, query.isSuccess);
  const open = inState(alerts, "open");
  const worst = worstOf(open);
  const words = worst ? `${t("alerts.open", { count: open.length })}, ${t(`alerts.worst.${worst}`)}` : t("alerts.calm");
  return (
    <>
      <Popover
        opened={opened}
        onChange={setOpened}
        position="bottom-end"
        width={400}
        shadow="md"
        withinPortal
        trapFocus
        returnFocus
      >
        <Popover.Target>
          <button
            type="button"
            className={styles.bell}
            data-severity={worst ?? undefined}
            aria-label={words}
            title={words}
            onClick={() => setOpened(!opened)}
          >
            <Bell size={17} aria-hidden="true" />
            {worst ? (
              <span className={styles.count}>
                <StatusGlyph status={signOf(worst)} size={12} />
                {open.length > MOST_SHOWN ? `${MOST_SHOWN}+` : open.length}
              </span>
            ) : null}
          </button>
        </Popover.Target>
        <Popover.Dropdown data-manage="" className={styles.list} aria-label={t("alerts.title")}>
          <Suspense fallback={null}>
            <AlertList slug={slug} onLeave={() => setOpened(false)} />
          </Suspense>
        </Popover.Dropdown>
      </Popover>
      <span className="visually-hidden" role="status">
        {said}
      </span>
    </>
  );
}
