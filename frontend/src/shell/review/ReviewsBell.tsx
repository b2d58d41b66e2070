/** The versions that wait for this person's review, shown where there are any. */
import { Popover } from "@mantine/core";
import { ClipboardCheck } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import styles from "./review.module.css";
import { reviewAddress, useAskedReviews } from "./review";

export function ReviewsBell({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const asked = useAskedReviews(slug).data ?? [];
  if (asked.length === 0) return null;
  const words = t("review.waiting", { count: asked.length });
  return (
    <Popover position="bottom-end" width={340} shadow="md" withinPortal trapFocus returnFocus>
      <Popover.Target>
        <button type="button" className={styles.bell} aria-label={words} title={words}>
          <ClipboardCheck size={17} aria-hidden /> <b>{asked.length}</b>
        </button>
      </Popover.Target>
      <Popover.Dropdown>
        <h2 className={styles.heading}>{words}</h2>
        <ul className={styles.asked}>
          {asked.map((each) => (
            <li key={each.program}>
              <Link to={reviewAddress(each)}>
                <b>{t("review.version_of", { program: each.program_name, number: each.number })}</b>
                <span>{t(each.note ? "review.asked_note" : "review.asked", { name: each.by, note: each.note })}</span>
              </Link>
            </li>
          ))}
        </ul>
      </Popover.Dropdown>
    </Popover>
  );
}
