/** What went wrong in a rehearsal, who came too near to whom, and who waited; a press goes to its moment. */
import { useTranslation } from "react-i18next";
import type { RehearsalError } from "@/api/types";
import { clock } from "@/design/clock";
import { type Incident, isNow } from "@/scene3d/incidents";
import { logWords } from "./logWords";
import styles from "./ResultPanel.module.css";
import type { ResultPanelProps } from "./resultProps";

export function Events(props: ResultPanelProps) {
  const { t } = useTranslation();
  const { incidents, result, wordsOf } = props;
  const { errors } = result;
  const met = incidents.some(({ kind }) => kind !== "wait");
  return (
    <div>
      {errors.length > 0 ? (
        <>
          <h3 className={styles.heading}>{t("simulation.problems")}</h3>
          <ul className={styles.list}>
            {errors.map((error) => (
              <Failure key={`${error.t}-${error.step}`} error={error} {...props} />
            ))}
          </ul>
        </>
      ) : null}
      <h3 className={styles.heading} id="incidents">
        {t(met ? "simulation.incidents" : "simulation.waits")}
      </h3>
      <ul className={styles.list} aria-labelledby="incidents">
        {incidents.map((incident) => (
          <Row key={incident.number} incident={incident} {...props} words={wordsOf(incident)} />
        ))}
        {incidents.length === 0 ? <li className={styles.none}>{t("simulation.noWaits")}</li> : null}
      </ul>
    </div>
  );
}

function Failure({ error, nameOf, numberOf, onJump }: ResultPanelProps & { error: RehearsalError }) {
  return (
    <li>
      <button type="button" className={`${styles.event} ${styles.bad}`} onClick={() => onJump(error.t, error.step)}>
        <b>
          {clock(error.t)} · {numberOf(error.step)}
        </b>
        {logWords({ ...error, device: "", text: error.message }, nameOf)}
      </button>
    </li>
  );
}

interface RowProps extends ResultPanelProps {
  incident: Incident;
  words: string;
}

function Row({ incident, words, nameOf, onJump, t_s }: RowProps) {
  const { t } = useTranslation();
  const { number, kind, robot, wait } = incident;
  return (
    <li>
      <button
        type="button"
        className={styles.event}
        aria-current={isNow(incident, t_s) || undefined}
        onClick={() => onJump(incident.t_s)}
      >
        <span className={styles.pin} data-kind={kind}>
          {number}
        </span>
        <span>
          <b>{wait ? nameOf(robot) : t(`simulation.incident.${kind}`)}</b> {clock(incident.t_s)}
          {wait ? `, ${Math.round(wait.duration_s)} s` : null}
          <br />
          {words}
        </span>
      </button>
    </li>
  );
}
