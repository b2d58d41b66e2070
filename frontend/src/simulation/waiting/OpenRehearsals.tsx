/** What of the site waits or is under way, in its order, with who has started it and a way to cancel it. */
import { X } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { ApiProblem } from "@/api/client";
import { mayOperate } from "@/api/roles";
import type { RehearsalSummary, Site } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import { useCancelRehearsal, useOpenRehearsals } from "../useRehearsals";
import { progressWords } from "./progress";
import styles from "./waiting.module.css";

export function OpenRehearsals({ site, except }: { site: Site; except?: string }) {
  const { t } = useTranslation();
  const others = useOpenRehearsals(site.slug).filter((each) => each.id !== except);
  const cancel = useCancelRehearsal(site.slug);
  if (others.length === 0) return null;
  return (
    <section className={styles.others} aria-labelledby="open-rehearsals">
      <h3 id="open-rehearsals">{t("simulation.queue.others")}</h3>
      {cancel.error instanceof ApiProblem ? <p role="alert">{cancel.error.detail}</p> : null}
      <ul>
        {others.map((each) => (
          <Row
            key={each.id}
            rehearsal={each}
            allowed={each.mine || mayOperate(site.role)}
            busy={cancel.isPending}
            onCancel={() => cancel.mutate(each.id)}
          />
        ))}
      </ul>
    </section>
  );
}

interface RowProps {
  rehearsal: RehearsalSummary;
  allowed: boolean;
  busy: boolean;
  onCancel: () => void;
}

function Row({ rehearsal, allowed, busy, onCancel }: RowProps) {
  const { t } = useTranslation();
  const { id, kind, program, program_name: name, started_by: by, place, course, mine } = rehearsal;
  return (
    <li>
      <span className={styles.position}>
        {place === null ? t("simulation.queue.running") : t("simulation.queue.place", { place })}
      </span>
      <span className={styles.what}>
        {kind === "tests" ? (
          <Link to={`/programs/${program}`}>{t("simulation.queue.tests", { name })}</Link>
        ) : (
          <Link to={`/programs/${program}/simulate/${id}`}>{name}</Link>
        )}{" "}
        {t(mine ? "simulation.queue.mine" : "simulation.queue.by", { by })}
        {course ? <small>{progressWords(course)}</small> : null}
      </span>
      {allowed ? (
        <IconButton label={t("simulation.queue.cancelOf", { program: name, by })} disabled={busy} onClick={onCancel}>
          <X size={16} aria-hidden="true" />
        </IconButton>
      ) : null}
    </li>
  );
}
