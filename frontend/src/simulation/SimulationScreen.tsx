import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { useParams, useSearchParams } from "react-router-dom";
import { useDevices, useProgram, useSite, useSiteMap } from "@/api/queries";
import type { Device, Program, Rehearsal, RehearsalResult } from "@/api/types";
import { Crumb, TopBar } from "@/shell/TopBar";
import { useFreshRehearsal, useWhyUnknown } from "@/live/rehearsal";
import { useSiteLive } from "@/live/site";
import { momentIn, useMomentInAddress } from "./address";
import { Actions } from "./Actions";
import { Filming } from "./film/Filming";
import { type Incident, incidentsOf } from "@/scene3d/incidents";
import { useTitle } from "@/shell/useTitle";
import { incidentWords } from "./incidents/incidentWords";
import { MapPane } from "./MapPane";
import { useFloorAt } from "./obstacles";
import { ResultPanel } from "./ResultPanel";
import { ScenePane } from "./ScenePane";
import { Sharing } from "./Sharing";
import styles from "./SimulationScreen.module.css";
import { neighbour, segmentsOf, stepStarts } from "./timeline";
import { Transport } from "./Transport";
import { useMoment } from "./useMoment";
import { useStartRehearsal } from "./useRehearsals";
import { WaitingPane } from "./waiting/WaitingPane";

const NO_DEVICES: Device[] = [];

function Recording(props: { rehearsal: Rehearsal; result: RehearsalResult; devices: Device[]; program: Program }) {
  const { t } = useTranslation();
  const { rehearsal, result, devices, program } = props;
  const site = useSiteMap(program.site).data;
  const [search] = useSearchParams();
  const player = useMoment(result.duration_s, momentIn(search));
  const [filming, setFilming] = useState(false);
  const map = useFloorAt(site, result, player.t_s);
  useMomentInAddress(player.t_s, player.playing);
  const [selected, setSelected] = useState<string | null>(null);
  const { compiled } = rehearsal;
  const topLevel = useMemo(() => {
    const outer = compiled.order.filter((step) => (compiled.depth[step] ?? 0) === 0);
    return new Set(outer);
  }, [compiled]);
  const segments = useMemo(() => segmentsOf(result.steps, topLevel, result.duration_s), [result, topLevel]);
  const starts = useMemo(() => stepStarts(result.steps), [result]);
  const incidents = useMemo(() => incidentsOf(result), [result]);
  const [mapLarge, setMapLarge] = useState(false);
  const nameOf = (id: string) => devices.find((device) => device.id === id)?.name ?? id;
  const wordsOf = (incident: Incident) => incidentWords(incident, nameOf);
  const numberOf = (step: string) => t("simulation.step", { number: compiled.numbers[step] ?? "" });
  return (
    <>
      <MapPane
        {...{ map, devices, result, compiled, selected, incidents, wordsOf }}
        large={mapLarge}
        onLarge={() => setMapLarge(!mapLarge)}
        onJump={player.seek}
        site={program.site}
        document={rehearsal.document}
        moment={player.moment}
        t_s={player.t_s}
        onSelect={setSelected}
      />
      <div className={styles.result}>
        <ResultPanel
          {...{ result, nameOf, numberOf, incidents, wordsOf }}
          t_s={player.t_s}
          asked={rehearsal.asked}
          onJump={(t_s, step) => {
            player.seek(t_s);
            if (step) setSelected(step);
          }}
        >
          <Sharing program={program.id} rehearsal={rehearsal.id} t_s={player.t_s} onFilm={() => setFilming(true)} />
        </ResultPanel>
        <Filming
          rehearsal={rehearsal.id}
          duration_s={result.duration_s}
          player={player}
          opened={filming}
          onClose={() => setFilming(false)}
        />
      </div>
      <ScenePane
        {...{ map, devices, result, incidents }}
        onJump={player.seek}
        moment={player.moment}
        t_s={player.t_s}
        playing={player.playing}
        filming={filming}
      />
      <Transport
        t_s={player.t_s}
        duration_s={result.duration_s}
        playing={player.playing}
        speed={player.speed}
        segments={segments}
        markers={incidents.map((each) => ({ ...each, label: wordsOf(each) }))}
        titleOf={(step) => compiled.numbers[step] ?? ""}
        onSeek={player.seek}
        onPlay={player.toggle}
        onSpeed={player.setSpeed}
        onStep={(direction) => player.seek(neighbour(starts, player.t_s, direction, result.duration_s))}
      />
    </>
  );
}

/** A program's rehearsal: the map and the 3D view at the same moment, the result, and the recording's transport. */
export function SimulationScreen() {
  const { t } = useTranslation();
  const { id = "", rehearsal: rehearsalId } = useParams();
  const program = useProgram(id).data;
  const site = useSite(program?.site).data;
  const devices = useDevices(program?.site).data ?? NO_DEVICES;
  const map = useSiteMap(program?.site).data;
  const rehearsal = useFreshRehearsal(rehearsalId);
  const { start, problem } = useStartRehearsal(id, rehearsal.data);
  useSiteLive(program?.site);
  useTitle(program && `${t("simulation.title")} · ${program.name}`);
  const data = rehearsal.data;
  const result = data?.status === "done" ? data.result : null;
  const unknown = useWhyUnknown(rehearsalId, rehearsal);
  const refusal = problem ?? unknown;
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
          program && site && data ? (
            <Actions {...{ program, site, map, devices }} rehearsal={data} onAgain={start} />
          ) : null
        }
      />
      <main className={styles.body}>
        {data && result && program && !problem ? (
          <Recording key={data.id} rehearsal={data} result={result} devices={devices} program={program} />
        ) : (
          <WaitingPane
            rehearsal={data}
            loading={rehearsal.isLoading}
            refusal={refusal}
            site={site}
            program={program}
            onAgain={start}
          />
        )}
      </main>
    </div>
  );
}
