/** How to begin: the demo's steps, ticked as they are really done, beside a picture of the factory. */
import { Button } from "@mantine/core";
import { Play, X } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { tellRefusal } from "@/shell/refusal";
import { hasTried, markTried } from "@/shell/triedSteps";
import { useDevices, useMe, usePrograms, useSiteMap } from "@/api/queries";
import { useRuns } from "@/api/runs";
import type { Program, Site, User } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import { Panel } from "@/design/Panel";
import { StatusGlyph } from "@/design/StatusGlyph";
import { mayEdit, useCreateProgram } from "../programs/NewProgram";
import { demoSteps, ownProgram, type DemoStep } from "./demoSteps";
import { FactoryPicture } from "./FactoryPicture";
import styles from "./home.module.css";

function Steps({ steps }: { steps: readonly DemoStep[] }) {
  const { t } = useTranslation();
  const next = steps.find((step) => !step.done);
  return (
    <ol className={styles.steps}>
      {steps.map((step, index) => (
        <li key={step.key} data-done={step.done || undefined} aria-current={step === next ? "step" : undefined}>
          {step.done ? <StatusGlyph status="done" size={18} /> : <span className={styles.stepNumber}>{index + 1}</span>}
          <span>
            <b>{t(`pages.home.step.${step.key}`)}</b>
            {step.done ? <span className="visually-hidden">{t("shell.status.done")}</span> : null}
            {step === next ? <small>{t(`pages.home.stepTime.${step.key}`)}</small> : null}
          </span>
        </li>
      ))}
    </ol>
  );
}

/** Goes to where the next step is done. */
function useContinue(site: Site, user: User, programs: readonly Program[], next: DemoStep | undefined) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const create = useCreateProgram(site.slug, (error) => tellRefusal(error, t));
  const own = ownProgram(user, programs) ?? programs.find((each) => each.name === t("pages.home.firstProgram"));
  const go = () => {
    if (next?.key === "look") void navigate(`/sites/${site.slug}/map`);
    else if (own) void navigate(`/programs/${own.id}`);
    else if (mayEdit(site.role)) create.mutate(t("pages.home.firstProgram"));
    else void navigate(`/sites/${site.slug}/programs`);
  };
  return { go, busy: create.isPending };
}

function useProgress(site: Site, user: User) {
  const programs = usePrograms(site.slug).data ?? [];
  const runs = useRuns(site.slug).data ?? [];
  const known = { user, programs, runs, lookedAround: hasTried("map"), simulated: hasTried("simulate") };
  const steps = demoSteps(known);
  return { programs, steps };
}

function Card({ site, user, hide }: { site: Site; user: User; hide: () => void }) {
  const { t } = useTranslation();
  const { programs, steps } = useProgress(site, user);
  const next = steps.find((step) => !step.done);
  const { go, busy } = useContinue(site, user, programs, next);
  const map = useSiteMap(site.slug).data;
  const devices = useDevices(site.slug).data ?? [];
  const begun = steps.some((step) => step.done);
  return (
    <Panel className={styles.begin} aria-labelledby="begin">
      <div className={styles.beginText}>
        <h2 id="begin">{t("pages.home.tryDemo")}</h2>
        <p>{t("pages.home.tryDemoText", { robots: site.robots, machines: site.machines })}</p>
        <Steps steps={steps} />
        <Button size="md" leftSection={<Play size={16} />} onClick={go} loading={busy}>
          {t(begun ? "pages.home.continue" : "pages.home.start")}
        </Button>
      </div>
      {map ? <FactoryPicture map={map} devices={devices} /> : <span />}
      <IconButton label={t("pages.home.hide")} className={styles.hide} onClick={hide}>
        <X size={17} aria-hidden="true" />
      </IconButton>
    </Panel>
  );
}

export function BeginCard({ site }: { site: Site }) {
  const user = useMe().data?.user;
  const [hidden, setHidden] = useState(() => hasTried("hidden"));
  const hide = () => {
    markTried("hidden");
    setHidden(true);
  };
  return user && site.simulated && !hidden ? <Card site={site} user={user} hide={hide} /> : null;
}
