/** What waits at the site, as figures: how many, and for how long the first of them has. */
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { Operations, Queue } from "@/api/types";
import { formatNumber, formatSpan } from "@/i18n/format";
import styles from "./operations.module.css";

/** Work that goes on is no sign of trouble, however long it takes. */
const AT_WORK = new Set(["under_way", "rehearsing"]);
/** What waits for longer than this is worth a look. */
const LONG_S = 10;

function Figure({ queue }: { queue: Queue }) {
  const { t } = useTranslation();
  const isLate = !AT_WORK.has(queue.name) && (queue.oldest_s ?? 0) > LONG_S;
  const nothing = t(AT_WORK.has(queue.name) ? "operations.underWay" : "operations.nothing");
  return (
    <div className={styles.figure} data-late={isLate || undefined}>
      <dt>{t(`operations.queue.${queue.name}`)}</dt>
      <dd>
        <b>{formatNumber(queue.waiting)}</b>
        <small>{queue.oldest_s === null ? nothing : t("operations.oldest", { ago: formatSpan(queue.oldest_s) })}</small>
      </dd>
    </div>
  );
}

export function Waiting({ slug, operations }: { slug: string; operations: Operations }) {
  const { t } = useTranslation();
  const runs = Object.entries(operations.runs).map(([state, count]) => `${t(`operations.run.${state}`)} ${count}`);
  return (
    <section aria-labelledby="operations-here">
      <div className={styles.sectionHead}>
        <h2 id="operations-here">{t("operations.here")}</h2>
        <Link to={`/sites/${slug}/runs`} className={styles.runs}>
          {t("operations.runs")}: {runs.join(" · ")}
        </Link>
      </div>
      <dl className={styles.figures}>
        {operations.queues.map((queue) => (
          <Figure key={queue.name} queue={queue} />
        ))}
      </dl>
    </section>
  );
}
