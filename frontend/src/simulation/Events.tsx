/** What went wrong in a rehearsal, who came too near to whom, and who waited. */
import { useTranslation } from "react-i18next";
import type { NearMiss, RehearsalError, RehearsalResult } from "@/api/types";
import { clock } from "@/design/clock";
import { waitWords } from "@/i18n/waits";
import { logWords } from "./logWords";
import styles from "./ResultPanel.module.css";
import type { ResultPanelProps } from "./resultProps";

export function Events(props: ResultPanelProps) {
  const { t } = useTranslation();
  const { errors, collisions, near_misses: near, waits } = props.result;
  return (
    <div>
      <h3 className={styles.heading}>{t(errors.length > 0 ? "simulation.problems" : "simulation.waits")}</h3>
      <ul className={styles.list}>
        {errors.map((error) => (
          <Failure key={`${error.t}-${error.step}`} error={error} {...props} />
        ))}
        {[...collisions, ...near].map((contact) => (
          <Contact key={`${contact.t}-${contact.a}-${contact.b}`} contact={contact} {...props} />
        ))}
        {waits.map((wait, index) => (
          <Wait key={`${wait.t}-${wait.robot}`} wait={wait} number={index + 1} {...props} />
        ))}
        {waits.length + errors.length + collisions.length + near.length === 0 && (
          <li className={styles.none}>{t("simulation.noWaits")}</li>
        )}
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

function Contact({ contact, nameOf, onJump }: ResultPanelProps & { contact: NearMiss }) {
  const { t } = useTranslation();
  const cm = Math.round(contact.distance_m * 100);
  return (
    <li>
      <button type="button" className={`${styles.event} ${styles.bad}`} onClick={() => onJump(contact.t)}>
        <b>{clock(contact.t)}</b>
        {t("simulation.near", { a: nameOf(contact.a), b: nameOf(contact.b), cm })}
      </button>
    </li>
  );
}

interface WaitProps extends ResultPanelProps {
  wait: RehearsalResult["waits"][number];
  number: number;
}

function Wait({ wait, number, nameOf, onJump }: WaitProps) {
  return (
    <li>
      <button type="button" className={styles.event} onClick={() => onJump(wait.t)}>
        <span className={styles.pin}>{number}</span>
        <span>
          <b>{nameOf(wait.robot)}</b> {clock(wait.t)}, {Math.round(wait.duration_s)} s
          <br />
          {waitWords(wait.why, nameOf) ?? wait.reason}
        </span>
      </button>
    </li>
  );
}
