/** What is going on at the site at this moment. */
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices, useOpenRuns, useRun } from "@/api/queries";
import type { Device, RunSummary } from "@/api/types";
import { Panel } from "@/design/Panel";
import { StatusBadge } from "@/design/StatusBadge";
import { StatusGlyph } from "@/design/StatusGlyph";
import { activityWords } from "@/i18n/activity";
import { formatClock } from "@/i18n/format";
import { reasonWords } from "@/i18n/reasons";
import { useAsHeld } from "@/live/held";
import { outerProgress, stepLines } from "@/run/stepList";
import { secondsOfRun, statusOfRun, underWay } from "../runs/runStatus";
import { useNow } from "@/design/useNow";
import styles from "./home.module.css";

const TELLING: readonly string[] = ["pending", "error", "warning", "busy", "waiting", "offline"];

function OpenRun({ run }: { run: RunSummary }) {
  const { t } = useTranslation();
  const seconds = secondsOfRun(run, useNow(1000));
  const compiled = useRun(run.id).data?.compiled;
  const { done, all } = outerProgress(compiled ? stepLines(compiled, run.steps) : []);
  const steps = all > 0 ? t("pages.runs.steps", { done, all }) : "";
  return (
    <Link to={`/runs/${run.id}`} className={styles.liveRun} data-status={run.status}>
      <span className={styles.liveTitle}>
        <StatusGlyph status={statusOfRun(run)} size={16} />
        <b>{t("pages.runs.numberOf", { number: run.number, program: run.program.name })}</b>
        <code>{seconds === null ? "" : formatClock(seconds)}</code>
      </span>
      <progress value={done} max={Math.max(1, all)} aria-label={steps || t("pages.runs.column.steps")} />
      <span className={styles.liveFoot}>
        <span>{reasonWords(run.cause, run.reason) || steps}</span>
        <b>{t("pages.home.openMonitor")}</b>
      </span>
    </Link>
  );
}

function DeviceLine({ device, slug }: { device: Device; slug: string }) {
  const { t } = useTranslation();
  return (
    <li>
      <Link to={`/sites/${slug}/devices/${device.id}`} className={styles.liveDevice}>
        <b>{device.name}</b>
        <StatusBadge status={device.status}>
          {device.status === "pending"
            ? t("shell.status.pending")
            : activityWords(device) || t(`shell.status.${device.status}`)}
        </StatusBadge>
      </Link>
    </li>
  );
}

export function LiveNow({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const known = useOpenRuns(slug).data;
  const runs = underWay(known ?? [], useNow());
  const devices = (useAsHeld(useDevices(slug).data) ?? [])
    .filter((device) => TELLING.includes(device.status))
    .sort((a, b) => TELLING.indexOf(a.status) - TELLING.indexOf(b.status));
  return (
    <Panel className={styles.live} aria-labelledby="live-now">
      <h2 id="live-now">{t("pages.home.liveNow")}</h2>
      {runs.slice(0, 2).map((run) => (
        <OpenRun key={run.id} run={run} />
      ))}
      {known && runs.length === 0 ? <p className={styles.quiet}>{t("pages.home.nothingRuns")}</p> : null}
      <ul>
        {devices.slice(0, runs.length > 0 ? 3 : 5).map((device) => (
          <DeviceLine key={device.id} device={device} slug={slug} />
        ))}
      </ul>
    </Panel>
  );
}
