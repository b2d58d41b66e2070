import { useQueryClient } from "@tanstack/react-query";
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { useParams } from "react-router-dom";
import { useAwaitedAdmissions } from "@/api/admissions";
import { missing } from "@/api/failed";
import { keys, useMeasurements, useQuestions, useRun, useSite } from "@/api/queries";
import type { Run } from "@/api/types";
import { AdmissionCard } from "@/shell/admissions/AdmissionCard";
import { QuestionCard } from "@/shell/questions/QuestionCard";
import { shownQuestions } from "@/shell/questions/openQuestions";
import { LoadProblem } from "@/shell/LoadProblem";
import { Crumb, TopBar } from "@/shell/TopBar";
import { Chip } from "@/design/Chip";
import { useTitle } from "@/shell/useTitle";
import { ProgramMap } from "@/program/ProgramMap";
import { byStep } from "@/device/paces/paces";
import { StandInMark } from "@/device/standIn/StandInMark";
import { formatMoment } from "@/i18n/format";
import { reasonWords } from "@/i18n/reasons";
import { liveRobots } from "@/live/robots";
import { useSiteLive } from "@/live/site";
import { useLiveStore } from "@/live/store";
import { RunAlerts } from "./RunAlerts";
import { RunActions, RunPill } from "./RunBar";
import styles from "./RunScreen.module.css";
import { RunDrawer, writeOn } from "./RunDrawer";
import { RunTerms } from "./RunTerms";
import { RunPlace } from "./scene/RunPlace";
import { isPlanned } from "./terms";
import { currentStep } from "./stepList";
import { Journal, RunSteps } from "./RunSteps";
import { elapsedSeconds, type LoadedProps, OVER, type RunView, useRunView } from "./runView";

function Notes({ run, now, problem }: { run: Run; now: number; problem: string | null }) {
  const { t } = useTranslation();
  const reason = reasonWords(run.cause, run.reason);
  return (
    <div className={styles.notes}>
      {problem && (
        <p className={styles.note} data-tone="error" role="alert">
          {problem}
        </p>
      )}
      {reason && run.status !== "running" && run.status !== "pending" && (
        <p className={styles.note} data-tone={run.status === "failed" ? "error" : "warn"}>
          <b>{t(`run.status.${run.status}`)}</b> {reason}
        </p>
      )}
      {run.not_before && isPlanned(run, now) ? (
        <p className={styles.note} data-tone="warn">
          {t("run.terms.waits", { at: formatMoment(run.not_before) })}
        </p>
      ) : null}
      {run.permit?.emergency ? (
        <p className={styles.note} data-tone="warn">
          {t("review.run.emergency", { why: run.permit.emergency })}
        </p>
      ) : null}
      {OVER.includes(run.status) ? null : <RunAlerts run={run} />}
    </div>
  );
}

/** What the run asks people, over the map. */
function RunQuestions({ run, allowed }: { run: Run; allowed: boolean }) {
  const questions = (useQuestions(run.site).data ?? []).filter((question) => question.run === run.id);
  const shown = shownQuestions(questions);
  const awaited = useAwaitedAdmissions(run.site).filter((each) => each.run === run.id);
  if (shown.length + awaited.length === 0) return null;
  return (
    <div className={styles.questions}>
      {shown.map((question) => (
        <QuestionCard key={question.id} question={question} allowed={allowed} />
      ))}
      {awaited.map((each) => (
        <AdmissionCard key={each.robot} slug={run.site} awaited={each} allowed={allowed} />
      ))}
    </div>
  );
}

/** A refusal, for as long as things stand as they stood when it came. */
function useProblem({ run, site }: LoadedProps) {
  const connection = useLiveStore((state) => state.connection);
  const now = `${run.status} ${site?.stop.active} ${connection}`;
  const [refusal, setRefusal] = useState({ text: "", at: "" });
  const setProblem = (text: string | null) => setRefusal({ text: text ?? "", at: now });
  return [refusal.at === now && refusal.text ? refusal.text : null, setProblem] as const;
}

function Loaded(props: LoadedProps) {
  const { t } = useTranslation();
  const view = useRunView(props);
  const [problem, setProblem] = useProblem(props);
  const { run, selected, setSelected } = view;
  return (
    <div className={styles.screen}>
      <RunTop view={view} onProblem={setProblem} />
      <main className={styles.body}>
        <section className={styles.map} aria-label={t("run.map")}>
          <RunPlace map={view.map} devices={view.devices}>
            <ProgramMap
              site={run.site}
              plan={view.map}
              trails
              controls
              devices={view.devices}
              document={run.document}
              compiled={run.compiled}
              statuses={run.steps}
              robots={liveRobots}
              selected={selected}
              onSelect={setSelected}
            />
          </RunPlace>
          <Notes run={run} now={view.now} problem={problem} />
          <RunQuestions run={run} allowed={view.allowed} />
        </section>
        <Side view={view} />
        <RunDrawer view={view} tell={setProblem} />
      </main>
    </div>
  );
}

function RunTop({ view, onProblem }: { view: RunView; onProblem: (problem: string | null) => void }) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const { run, site } = view;
  return (
    <TopBar
      site={run.site}
      crumbs={
        <>
          <Crumb to="/">{site?.name ?? ""}</Crumb>
          <Crumb to={`/programs/${run.program.id}`}>{run.program.name}</Crumb>
          <Crumb>{t("run.title", { number: run.number })}</Crumb>
        </>
      }
      chips={
        <span className={styles.chips}>
          {run.version !== null && <Chip mono>v{run.version}</Chip>}
          {run.archived && <Chip>{t("run.archived")}</Chip>}
        </span>
      }
      actions={
        <RunActions
          run={run}
          allowed={view.allowed}
          onProblem={onProblem}
          onDone={() => void queries.invalidateQueries({ queryKey: keys.run(run.id) })}
        />
      }
    >
      <RunPill run={run} elapsed_s={elapsedSeconds(run, view.now)} now={view.now} />
    </TopBar>
  );
}

/** What is not usual about the run, over its steps: the bar has no room for it. Empty where there is nothing. */
function Facts({ view }: { view: RunView }) {
  const { t } = useTranslation();
  return (
    <div className={styles.facts}>
      {view.site?.simulated && <Chip>{t("run.simulated")}</Chip>}
      {view.simulated.size > 0 && <Simulated view={view} />}
      <RunTerms run={view.run} now={view.now} />
    </div>
  );
}

/** Which devices were simulated in the run. */
function Simulated({ view }: { view: RunView }) {
  const { t } = useTranslation();
  const devices = [...view.simulated].map(view.nameOf).join(", ");
  return <StandInMark title={t("device.standIn.inRun", { devices })}>{devices}</StandInMark>;
}

/** The steps and the journal. */
function Side({ view }: { view: RunView }) {
  const { t } = useTranslation();
  const { run, lines, words, numberOf, nameOf } = view;
  const measurements = useMeasurements(run.id).data;
  const measured = useMemo(() => byStep(measurements ?? []), [measurements]);
  return (
    <aside className={styles.side}>
      <Facts view={view} />
      <RunSteps
        lines={lines}
        current={view.over ? null : currentStep(lines)}
        now={view.now}
        selected={view.selected}
        titleOf={words.titleOf}
        iconOf={words.iconOf}
        nameOf={nameOf}
        measured={measured}
        onSelect={view.setSelected}
      />
      <Journal
        journal={view.journal}
        numberOf={numberOf}
        nameOf={nameOf}
        label={t("run.journal")}
        onWrite={writeOn(view)}
      />
    </aside>
  );
}

/** A run, at any time: the program on the map with its steps lit, the robots live, the journal, the timeline. */
export function RunScreen() {
  const { t } = useTranslation();
  const { id } = useParams();
  const query = useRun(id);
  const run = query.data;
  const site = useSite(run?.site).data;
  useSiteLive(run?.site);
  useTitle(run && `${t("run.title", { number: run.number })} · ${run.program.name}`);
  if (run) return <Loaded key={run.id} run={run} site={site} />;
  const failed = missing(query);
  return (
    <div className={styles.screen}>
      <TopBar site={undefined} />
      <main className={styles.loading} role={failed ? undefined : "status"}>
        {failed ? <LoadProblem error={failed} again={() => void query.refetch()} /> : t("run.loading")}
      </main>
    </div>
  );
}
