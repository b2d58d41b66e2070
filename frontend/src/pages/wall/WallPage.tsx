/** A site on a screen in a hall: read only, without names of people, in large type, and nothing to press. */
import { CircleAlert, OctagonX, TriangleAlert } from "lucide-react";
import { useMemo } from "react";
import { useTranslation } from "react-i18next";
import { EmptyState } from "@/design/EmptyState";
import { Logo } from "@/design/Logo";
import { StatusGlyph } from "@/design/StatusGlyph";
import { useNow } from "@/design/useNow";
import { useTitle } from "@/shell/useTitle";
import { formatAgo, formatTime } from "@/i18n/format";
import { waitWords } from "@/i18n/waits";
import { StaticMap } from "@/map/StaticMap";
import { doingWords } from "./doingWords";
import { statusWords } from "./statusWords";
import { useWall, type Wall } from "./useWall";
import { countOnline, type Picture, type WallAlert, type WallRun } from "./wall";
import styles from "./wall.module.css";

function LineState({ line, heardAt }: Pick<Wall, "line" | "heardAt">) {
  const { t } = useTranslation();
  if (line === "live")
    return (
      <p className={styles.line} data-line="live" role="status">
        <span className={styles.dot} aria-hidden="true" />
        {t("wall.live")}
      </p>
    );
  const when = heardAt === null ? t("wall.noNews") : t("wall.lastNews", { time: timeOf(heardAt) });
  return (
    <p className={styles.line} data-line="away" role="status">
      <TriangleAlert size="1.1em" aria-hidden="true" />
      <b>{t(line === "connecting" ? "wall.connecting" : "wall.notLive")}</b> {line === "connecting" ? null : when}
    </p>
  );
}

const timeOf = (ms: number) => formatTime(new Date(ms).toISOString());

function Stop({ stop }: { stop: Picture["stop"] }) {
  const { t } = useTranslation();
  if (!stop.active) return null;
  return (
    <p className={styles.stop} role="alert">
      <OctagonX size="1.2em" aria-hidden="true" />
      <b>{t("wall.stopped")}</b> {stop.at ? t("wall.stoppedSince", { time: formatTime(stop.at) }) : null}
    </p>
  );
}

function RunCard({ run, nameOf, now }: { run: WallRun; nameOf: (device: string) => string; now: number }) {
  const { t } = useTranslation();
  const steps = t("wall.progress", { done: run.done, total: run.total });
  const glyph = run.status === "running" ? "busy" : run.status === "paused" ? "waiting" : "idle";
  return (
    <li className={styles.card}>
      <p className={styles.cardTitle}>
        <StatusGlyph status={glyph} size={22} />
        <b>{run.program}</b>
        <span>{t("wall.run", { number: run.number })}</span>
      </p>
      <progress value={run.done} max={Math.max(1, run.total)} aria-label={steps} />
      <p className={styles.cardFoot}>
        <span>{waitWords(run.wait, nameOf) ?? statusWords(run, now)}</span>
        <span>{steps}</span>
      </p>
    </li>
  );
}

const SIGNS = { error: "error", warning: "warning", info: "idle" } as const;

function AlertCard({ alert, nameOf, now }: { alert: WallAlert; nameOf: (id: string) => string; now: number }) {
  const { t } = useTranslation();
  return (
    <li className={styles.card} data-severity={alert.severity}>
      <p className={styles.cardTitle}>
        <StatusGlyph status={SIGNS[alert.severity]} size={22} />
        <b>{nameOf(alert.device)}</b>
        <span>{formatAgo(alert.last_at, now)}</span>
      </p>
      <p className={styles.cardFoot}>
        <span>{t(`wall.what.${alert.code}`)}</span>
        {alert.count > 1 ? <span>{t("wall.times", { count: alert.count })}</span> : null}
      </p>
    </li>
  );
}

function Side({ picture }: { picture: Picture }) {
  const { t } = useTranslation();
  const now = useNow();
  const nameOf = (id: string) => picture.devices.find((device) => device.id === id)?.name ?? id;
  return (
    <div className={styles.side}>
      <section aria-labelledby="wall-runs">
        <h2 id="wall-runs">{t("wall.runs")}</h2>
        {picture.runs.length === 0 ? <p className={styles.none}>{t("wall.noRuns")}</p> : null}
        <ul>
          {picture.runs.map((run) => (
            <RunCard key={run.number} run={run} nameOf={nameOf} now={now} />
          ))}
        </ul>
      </section>
      <section aria-labelledby="wall-alerts">
        <h2 id="wall-alerts">{t("wall.alerts")}</h2>
        {picture.alerts.length === 0 ? <p className={styles.none}>{t("wall.noAlerts")}</p> : null}
        <ul>
          {picture.alerts.map((alert) => (
            <AlertCard key={alert.id} alert={alert} nameOf={nameOf} now={now} />
          ))}
        </ul>
        {picture.more_alerts > 0 ? (
          <p className={styles.none}>{t("wall.more", { count: picture.more_alerts })}</p>
        ) : null}
      </section>
    </div>
  );
}

function Floor({ wall, picture }: { wall: Wall; picture: Picture }) {
  const { t } = useTranslation();
  const machines = useMemo(
    () =>
      picture.devices
        .filter((device) => device.kind !== "robot")
        .map((device) => ({ ...device, doing: doingWords(device) })),
    [picture.devices],
  );
  return (
    <section className={styles.floor}>
      <StaticMap
        plan={wall.plan}
        devices={machines}
        robots={wall.robots}
        named
        label={t("wall.map", { site: picture.site })}
      />
    </section>
  );
}

function Ended({ line }: { line: "ended" | "many" }) {
  const { t } = useTranslation();
  return (
    <main className={styles.ended}>
      <EmptyState
        as="h1"
        icon={<CircleAlert size={32} />}
        title={t(`wall.${line}`)}
        text={t(line === "many" ? "wall.manyText" : "wall.endedText")}
      />
    </main>
  );
}

export function WallPage() {
  const { t } = useTranslation();
  const wall = useWall();
  const { picture, line } = wall;
  const title = picture?.site ?? t("wall.title");
  useTitle(title);
  if (line === "ended" || line === "many") return <Ended line={line} />;
  const counts = countOnline(picture?.devices ?? []);
  return (
    <main className={styles.wall} data-live={line === "live" || undefined}>
      <header className={styles.head}>
        <Logo size={40} />
        <h1>{title}</h1>
        {picture ? <p>{t("wall.online", { online: counts.online, all: counts.all })}</p> : null}
        <LineState line={line} heardAt={wall.heardAt} />
        <Clock />
      </header>
      {picture ? <Stop stop={picture.stop} /> : null}
      {picture ? (
        <div className={styles.body}>
          <Floor wall={wall} picture={picture} />
          <Side picture={picture} />
        </div>
      ) : null}
    </main>
  );
}

function Clock() {
  const now = useNow(1000);
  return <time className={styles.clock}>{timeOf(now).replace(/(\d+:\d+):\d+/, "$1")}</time>;
}
