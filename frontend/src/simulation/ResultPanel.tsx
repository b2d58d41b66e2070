import { AlertOctagon, CircleCheck } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { RehearsalResult } from "@/api/types";
import { clock } from "@/design/clock";
import { formatNumber } from "@/i18n/format";
import { Course } from "./Course";
import { Events } from "./Events";
import styles from "./ResultPanel.module.css";
import type { ResultPanelProps } from "./resultProps";

function Fact({ label, value, unit, note }: { label: string; value: string; unit: string; note?: string }) {
  return (
    <div className={styles.fact}>
      <span className={styles.factLabel}>{label}</span>
      <span className={styles.factValue}>
        {value} <small>{unit}</small>
      </span>
      <span className={styles.factNote}>{note}</span>
    </div>
  );
}

function Facts({ result }: { result: RehearsalResult }) {
  const { t } = useTranslation();
  const robots = Object.values(result.robots).filter((robot) => robot.distance_m > 0.05);
  const distance = robots.reduce((sum, robot) => sum + robot.distance_m, 0);
  const waited = result.waits.reduce((sum, wait) => sum + wait.duration_s, 0);
  const lowest = Math.min(...Object.values(result.robots).map((robot) => robot.battery));
  return (
    <div className={styles.facts}>
      <Fact
        label={t("simulation.time")}
        value={clock(result.duration_s)}
        unit={t("simulation.minutes")}
        note={t("simulation.simulatedTimeNote")}
      />
      <Fact
        label={t("simulation.distance")}
        value={formatNumber(distance, 1)}
        unit="m"
        note={t("simulation.robotsDrove", { count: robots.length })}
      />
      <Fact
        label={t("simulation.waits")}
        value={String(result.waits.length)}
        unit=""
        note={t("simulation.secondsWaited", { seconds: Math.round(waited) })}
      />
      {Number.isFinite(lowest) && (
        <Fact
          label={t("simulation.battery")}
          value={formatNumber(lowest)}
          unit="%"
          note={t("simulation.lowestRobot")}
        />
      )}
    </div>
  );
}

function Use({ id, busy_s, total_s, name }: { id: string; busy_s: number; total_s: number; name: string }) {
  const share = total_s > 0 ? Math.min(busy_s / total_s, 1) : 0;
  return (
    <li className={styles.use} data-device={id}>
      <span>{name}</span>
      <span className={styles.track}>
        <span style={{ width: `${share * 100}%` }} />
      </span>
      <span className={styles.percent}>{Math.round(share * 100)} %</span>
    </li>
  );
}

/** Under which conditions it was rehearsed. */
function Conditions({ asked }: Pick<ResultPanelProps, "asked">) {
  const { t } = useTranslation();
  if (!asked) return null;
  const measured = Object.values(asked.paces).reduce((sum, methods) => sum + Object.keys(methods).length, 0);
  const parts = [
    t("simulation.conditions.version", { version: asked.version }),
    t(`start.rehearse.drivers.${asked.driver}.name`),
    t("simulation.conditions.seed", { seed: asked.seed }),
    ...Object.entries(asked.parameters).map(([name, value]) => `${name} = ${String(value)}`),
    ...(measured > 0 ? [t("simulation.conditions.paces", { count: measured })] : []),
    ...(asked.faults.length > 0 ? [t("simulation.conditions.faults", { count: asked.faults.length })] : []),
  ];
  return (
    <p className={styles.conditions}>
      <b>{t("simulation.conditions.title")}</b> {parts.join(" · ")}
    </p>
  );
}

function Utilisation({ result, nameOf }: ResultPanelProps) {
  const { t } = useTranslation();
  const used = [...Object.entries(result.robots), ...Object.entries(result.machines)].filter(
    ([, use]) => use.busy_s >= 0.005 * result.duration_s,
  );
  return (
    <div>
      <h3 className={styles.heading}>{t("simulation.utilisation")}</h3>
      <ul className={styles.list}>
        {used.map(([id, use]) => (
          <Use key={id} id={id} busy_s={use.busy_s} total_s={result.duration_s} name={nameOf(id)} />
        ))}
      </ul>
    </div>
  );
}

/** What the rehearsal says: does it finish, how long it takes, who is used how much, who waits for whom. */
export function ResultPanel(props: ResultPanelProps) {
  const { t } = useTranslation();
  const { result } = props;
  return (
    <section className={styles.panel} aria-label={t("simulation.result")}>
      <header className={styles.header}>
        <h2>{t("simulation.result")}</h2>
        <span className={result.ok ? styles.good : styles.failed} role="status">
          {result.ok ? <CircleCheck size={14} aria-hidden /> : <AlertOctagon size={14} aria-hidden />}
          {result.ok
            ? t("simulation.finishes")
            : t("simulation.stopsWithErrors", { count: Math.max(1, result.errors.length) })}
        </span>
        {props.children}
      </header>
      <Conditions asked={props.asked} />
      <Facts result={result} />
      <div className={styles.columns}>
        <Utilisation {...props} />
        <Events {...props} />
      </div>
      <Course {...props} />
    </section>
  );
}
