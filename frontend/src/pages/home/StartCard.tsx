/** From an empty site to its first program: what is done, what is next, and where; else something else. */
import { Button } from "@mantine/core";
import { ArrowRight } from "lucide-react";
import { useMemo, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices, usePrograms, useSiteMap } from "@/api/queries";
import { useRobotMap } from "@/api/robotMaps";
import type { Device, Site, SiteMap } from "@/api/types";
import { Panel } from "@/design/Panel";
import { StatusGlyph } from "@/design/StatusGlyph";
import { StaticMap } from "@/map/StaticMap";
import { tellRefusal } from "@/shell/refusal";
import { planOf } from "../devices/robotMap/robotPlan";
import { MappingRobots, useMappingRobots } from "../map/MappingRobots";
import { useCreateProgram } from "../programs/NewProgram";
import styles from "./home.module.css";
import { mayDo, startSteps, whereTo, type StartStep } from "./startSteps";

/** The steps that are known; null while that is being asked. */
function useSteps(site: Site, map: SiteMap | undefined): readonly StartStep[] | null {
  const programs = usePrograms(site.slug).data;
  if (!programs || (site.has_map && !map)) return null;
  return startSteps({
    hasMap: site.has_map,
    places: map?.places.length ?? 0,
    devices: site.robots + site.machines,
    programs: programs.length,
  });
}

export function StartCard({ site, otherwise }: { site: Site; otherwise: ReactNode }) {
  const { t } = useTranslation();
  const map = useSiteMap(site.has_map ? site.slug : undefined).data;
  const devices = useDevices(site.slug).data ?? [];
  const steps = useSteps(site, map);
  const next = steps?.find((step) => !step.done);
  if (!steps || !next) return otherwise;
  return (
    <Panel className={styles.begin} aria-labelledby="start">
      <div className={styles.beginText}>
        <h2 id="start">{t("mapEdit.start.title", { site: site.name })}</h2>
        <p>{t("mapEdit.start.text")}</p>
        <Steps site={site} steps={steps} next={next} />
        <Next site={site} step={next} />
      </div>
      <div className={styles.startMap}>
        {map ? (
          <StaticMap plan={map} devices={devices} label={t("pages.map.of", { site: site.name })} />
        ) : (
          <Unmapped slug={site.slug} />
        )}
      </div>
    </Panel>
  );
}

/** Where there is no map yet: the one that a robot is making, or a word. */
function Unmapped({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const robot = useMappingRobots(slug).find((each) => each.lifecycle === "approved");
  const none = <p>{t("mapEdit.start.picture")}</p>;
  return robot ? <GrowingMap slug={slug} robot={robot} otherwise={none} /> : none;
}

function GrowingMap({ slug, robot, otherwise }: { slug: string; robot: Device; otherwise: ReactNode }) {
  const { t } = useTranslation();
  const { data: map } = useRobotMap(slug, robot.id);
  const plan = useMemo(() => (map ? planOf(map) : null), [map]);
  if (!plan) return otherwise;
  return <StaticMap plan={plan} devices={[robot]} label={t("mapEdit.start.growing", { name: robot.name })} />;
}

function Steps({ site, steps, next }: { site: Site; steps: readonly StartStep[]; next: StartStep }) {
  const { t } = useTranslation();
  const hint = (step: StartStep) =>
    step.key === "devices" && site.pending > 0
      ? t("mapEdit.start.devicesPending", { count: site.pending })
      : t(`mapEdit.start.${step.key}Next`);
  return (
    <ol className={styles.steps}>
      {steps.map((step, index) => (
        <li key={step.key} data-done={step.done || undefined} aria-current={step === next ? "step" : undefined}>
          {step.done ? <StatusGlyph status="done" size={18} /> : <span className={styles.stepNumber}>{index + 1}</span>}
          <span>
            <b>{t(`mapEdit.start.${step.key}`)}</b>
            {step.done ? <span className="visually-hidden">{t("shell.status.done")}</span> : null}
            {step === next ? <small>{hint(step)}</small> : null}
          </span>
        </li>
      ))}
    </ol>
  );
}

function Next({ site, step }: { site: Site; step: StartStep }) {
  const { t } = useTranslation();
  const create = useCreateProgram(site.slug, (error) => tellRefusal(error, t));
  const { key } = step;
  const words = t(`mapEdit.start.go.${key}`);
  const icon = <ArrowRight size={16} aria-hidden="true" />;
  if (!mayDo(site.role, step))
    return (
      <>
        <p role="note">{t(`mapEdit.start.needs.${step.needs}`)}</p>
        <Button component={Link} to={`/sites/${site.slug}/map`} variant="default">
          {t("mapEdit.start.look")}
        </Button>
      </>
    );
  if (key === "program")
    return (
      <Button
        size="md"
        rightSection={icon}
        loading={create.isPending}
        onClick={() => create.mutate(t("pages.home.firstProgram"))}
      >
        {words}
      </Button>
    );
  const go = (
    <Button size="md" component={Link} to={whereTo(site.slug, key)} rightSection={icon}>
      {words}
    </Button>
  );
  if (key !== "map") return go;
  return (
    <div className={styles.choices}>
      {go}
      <MappingRobots slug={site.slug} waiting />
    </div>
  );
}
