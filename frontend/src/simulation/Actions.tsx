/** What can be done from a rehearsal: back to the drawing, once more, otherwise, and for real. */
import { Button } from "@mantine/core";
import { ArrowLeft, Play, RefreshCw, SlidersHorizontal } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate } from "react-router-dom";
import { mayOperate } from "@/api/roles";
import type { Device, Program, Rehearsal, Site, SiteMap } from "@/api/types";
import { clock } from "@/design/clock";
import type { Fact } from "@/design/FactList";
import { conditionsOf } from "@/shell/start/conditions";
import { RehearseDialog } from "@/shell/start/RehearseDialog";
import { RunDialog } from "@/shell/start/RunForm";
import type { Startable } from "@/shell/start/startable";
import styles from "./SimulationScreen.module.css";

interface ActionsProps {
  program: Program;
  site: Site;
  map: SiteMap | undefined;
  devices: readonly Device[];
  rehearsal: Rehearsal;
  onAgain: () => void;
}

type Open = "with" | "run" | null;

const stored = () => Promise.resolve();

export function Actions(props: ActionsProps) {
  const { t } = useTranslation();
  const { program, site, rehearsal } = props;
  const [open, setOpen] = useState<Open>(null);
  const { result } = rehearsal;
  const close = () => setOpen(null);
  return (
    <>
      <Button
        component={Link}
        to={`/programs/${program.id}`}
        variant="default"
        className={styles.sign}
        title={t("simulation.backToEditor")}
        leftSection={<ArrowLeft size={16} aria-hidden="true" />}
      >
        <span className={styles.words}>{t("simulation.backToEditor")}</span>
      </Button>
      {result && mayOperate(site.role) ? (
        <>
          <Button
            variant="default"
            className={styles.sign}
            title={t("simulation.again")}
            leftSection={<RefreshCw size={16} aria-hidden="true" />}
            onClick={props.onAgain}
          >
            <span className={styles.words}>{t("simulation.again")}</span>
          </Button>
          <Button
            variant="default"
            className={styles.sign}
            title={t("start.rehearse.begin")}
            leftSection={<SlidersHorizontal size={16} aria-hidden="true" />}
            onClick={() => setOpen("with")}
          >
            <span className={styles.words}>{t("start.rehearse.begin")}</span>
          </Button>
          <Button leftSection={<Play size={16} aria-hidden="true" />} onClick={() => setOpen("run")}>
            {t("editor.run")}
          </Button>
          <Dialogs {...props} open={open} onClose={close} />
        </>
      ) : null}
    </>
  );
}

/** The dialogs take the program as it was rehearsed; a rehearsal is of what is drawn now, a run of what was rehearsed. */
function Dialogs({ open, onClose, ...props }: ActionsProps & { open: Open; onClose: () => void }) {
  const navigate = useNavigate();
  const { t } = useTranslation();
  const { program, site, map, devices, rehearsal } = props;
  const { asked, document, compiled, result } = rehearsal;
  const about: Startable = {
    program,
    site,
    document,
    compiled,
    devices,
    places: map?.places ?? [],
    version: null,
    stored,
  };
  const first = conditionsOf(asked);
  const outcome: Fact = result?.ok
    ? { tone: "done", text: t("start.run.rehearsed_well", { time: clock(result.duration_s) }) }
    : { tone: "warn", text: t("start.run.rehearsed_badly", { count: Math.max(1, result?.errors.length ?? 1) }) };
  const what: Fact = asked
    ? { tone: "plain", text: t("start.run.version", { version: asked.version }) }
    : { tone: "plain", text: t("start.run.drawn_now") };
  return (
    <>
      <RehearseDialog
        opened={open === "with"}
        about={about}
        first={first}
        onClose={onClose}
        onStarted={(id) => void navigate(`/programs/${program.id}/simulate/${id}`)}
      />
      <RunDialog
        opened={open === "run"}
        about={{ ...about, version: asked?.version ?? null }}
        errors={0}
        warnings={0}
        given={first.parameters}
        facts={[what, outcome]}
        onClose={onClose}
      />
    </>
  );
}
