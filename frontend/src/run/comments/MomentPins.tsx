/** Pins on the timeline at moments with open comments; those that would lie on each other are one. */
import { useTranslation } from "react-i18next";
import { clock } from "@/design/clock";
import { pinsOnTimeline } from "./momentPins";
import styles from "./runComments.module.css";
import type { RunComments } from "./useRunComments";

export function MomentPins({ comments, span_s }: { comments: RunComments; span_s: number }) {
  const { t } = useTranslation();
  const pins = pinsOnTimeline(comments.threads, span_s);
  return pins.map(({ t_s, threads, unread }) => (
    <button
      key={t_s}
      type="button"
      className={styles.pin}
      style={{ left: `${(t_s / span_s) * 100}%` }}
      data-unread={unread > 0 || undefined}
      aria-label={t("comments.pin", { count: threads.length, what: clock(t_s) })}
      onClick={() => comments.open(threads[0]?.id ?? null)}
    >
      {threads.length}
    </button>
  ));
}
