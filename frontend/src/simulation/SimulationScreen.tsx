import { Button } from "@mantine/core";
import { useQueryClient } from "@tanstack/react-query";
import { ArrowLeft, RefreshCw } from "lucide-react";
import { useEffect, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate, useParams } from "react-router-dom";
import { ApiProblem } from "@/api/client";
import { useOnce } from "@/api/once";
import { missing } from "@/api/failed";
import { keys, useDevices, useProgram, useRehearsal, useSite, useSiteMap } from "@/api/queries";
import type { Device, Program, Rehearsal, RehearsalResult } from "@/api/types";
import { Crumb, TopBar } from "@/shell/TopBar";
import { waitWords } from "@/i18n/waits";
import { useSiteLive } from "@/live/site";
import { MapPane } from "./MapPane";
import { ResultPanel } from "./ResultPanel";
import { ScenePane } from "./ScenePane";
import styles from "./SimulationScreen.module.css";
import { neighbour, segmentsOf, stepStarts } from "./timeline";
import { Transport, type Marker } from "./Transport";
import { useMoment } from "./useMoment";

const POLL_MS = 1000;
const NO_DEVICES: Device[] = [];

/** Ask for the rehearsal again until it is over; the live socket is faster, this holds when it is away. */
function useFreshRehearsal(id: string | undefined) {
  const query = useRehearsal(id);
  const queries = useQueryClient();
  const status = query.data?.status;
  useEffect(() => {
    if (!id || status === "done" || status === "failed") return;
    const timer = setInterval(() => void queries.invalidateQueries({ queryKey: keys.rehearsal(id) }), POLL_MS);
    return () => clearInterval(timer);
  }, [id, status, queries]);
  return query;
}

interface WaitingProps {
  rehearsal?: Rehearsal;
  /** It is not known yet how the rehearsal stands. */
  loading: boolean;
  problem?: string;
  onAgain: () => void;
}

function Waiting({ rehearsal, loading, problem, onAgain }: WaitingProps) {
  const { t } = useTranslation();
  const failed = problem !== undefined || rehearsal?.status === "failed";
  return (
    <section className={`${styles.pane} ${styles.waiting}`} aria-live="polite">
      <h2>
        {t(failed ? "simulation.failedTitle" : rehearsal || loading ? "simulation.running" : "simulation.noRehearsal")}
      </h2>
      {failed && <p role="alert">{problem ?? rehearsal?.result?.errors[0]?.message}</p>}
      {!failed && rehearsal && (
        <>
          <progress
            className={styles.progress}
            max={1}
            value={rehearsal.progress}
            aria-label={t("simulation.running")}
          />
          <p>{t("simulation.runningHint")}</p>
        </>
      )}
      {(failed || (!rehearsal && !loading)) && (
        <Button onClick={onAgain}>{t(failed ? "simulation.again" : "simulation.start")}</Button>
      )}
    </section>
  );
}

function Recording(props: { rehearsal: Rehearsal; result: RehearsalResult; devices: Device[]; program: Program }) {
  const { t } = useTranslation();
  const { rehearsal, result, devices, program } = props;
  const map = useSiteMap(program.site).data;
  const player = useMoment(result.duration_s);
  const [selected, setSelected] = useState<string | null>(null);
  const { compiled } = rehearsal;
  const topLevel = useMemo(() => {
    const outer = compiled.order.filter((step) => (compiled.depth[step] ?? 0) === 0);
    return new Set(outer);
  }, [compiled]);
  const segments = useMemo(() => segmentsOf(result.steps, topLevel, result.duration_s), [result, topLevel]);
  const starts = useMemo(() => stepStarts(result.steps), [result]);
  const nameOf = (id: string) => devices.find((device) => device.id === id)?.name ?? id;
  const numberOf = (step: string) => t("simulation.step", { number: compiled.numbers[step] ?? "" });
  return (
    <>
      <MapPane
        {...{ map, devices, result, compiled, selected }}
        site={program.site}
        document={rehearsal.document}
        moment={player.moment}
        t_s={player.t_s}
        onSelect={setSelected}
      />
      <div className={styles.result}>
        <ResultPanel
          {...{ result, nameOf, numberOf }}
          onJump={(t_s, step) => {
            player.seek(t_s);
            if (step) setSelected(step);
          }}
        />
      </div>
      <ScenePane {...{ map, devices, result }} moment={player.moment} t_s={player.t_s} playing={player.playing} />
      <Transport
        t_s={player.t_s}
        duration_s={result.duration_s}
        playing={player.playing}
        speed={player.speed}
        segments={segments}
        markers={markersOf(result, nameOf)}
        titleOf={(step) => compiled.numbers[step] ?? ""}
        onSeek={player.seek}
        onPlay={player.toggle}
        onSpeed={player.setSpeed}
        onStep={(direction) => player.seek(neighbour(starts, player.t_s, direction, result.duration_s))}
      />
    </>
  );
}

function markersOf(result: RehearsalResult, nameOf: (device: string) => string): Marker[] {
  return result.waits.map((wait) => ({
    t_s: wait.t,
    label: `${nameOf(wait.robot)}: ${waitWords(wait.why, nameOf) ?? wait.reason}`,
  }));
}

function useStartRehearsal(program: string) {
  const navigate = useNavigate();
  const [problem, setProblem] = useState<string>();
  const begin = useOnce();
  const start = () =>
    begin<{ id: string }>(`/programs/${program}/rehearsals`, {})
      .then(({ id }) => {
        setProblem(undefined);
        void navigate(`/programs/${program}/simulate/${id}`, { replace: true });
      })
      .catch((error: unknown) => {
        if (!(error instanceof ApiProblem)) throw error;
        setProblem(error.detail);
      });
  return { start: () => void start(), problem };
}

/** A program's rehearsal: the map and the 3D view at the same moment, the result, and the recording's transport. */
export function SimulationScreen() {
  const { t } = useTranslation();
  const { id = "", rehearsal: rehearsalId } = useParams();
  const program = useProgram(id).data;
  const site = useSite(program?.site).data;
  const devices = useDevices(program?.site).data ?? NO_DEVICES;
  const rehearsal = useFreshRehearsal(rehearsalId);
  const { start, problem } = useStartRehearsal(id);
  useSiteLive(program?.site);
  const data = rehearsal.data;
  const result = data?.status === "done" ? data.result : null;
  const refusal = problem ?? missing(rehearsal)?.message;
  return (
    <div className={styles.screen}>
      <TopBar
        site={program?.site}
        crumbs={
          <>
            <Crumb to="/">{site?.name ?? ""}</Crumb>
            <Crumb to={`/programs/${id}`}>{program?.name ?? ""}</Crumb>
            <Crumb>{t("simulation.title")}</Crumb>
          </>
        }
        actions={
          <>
            <Button component={Link} to={`/programs/${id}`} variant="default" leftSection={<ArrowLeft size={16} />}>
              {t("simulation.backToEditor")}
            </Button>
            {result && (
              <Button onClick={start} leftSection={<RefreshCw size={16} />}>
                {t("simulation.again")}
              </Button>
            )}
          </>
        }
      />
      <main className={styles.body}>
        {data && result && program ? (
          <Recording key={data.id} rehearsal={data} result={result} devices={devices} program={program} />
        ) : (
          <Waiting rehearsal={data} loading={rehearsal.isLoading} problem={refusal} onAgain={start} />
        )}
      </main>
    </div>
  );
}
