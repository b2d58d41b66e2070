import { Button, Group, Modal, Text } from "@mantine/core";
import { ArrowLeft, Pause, Play, X } from "lucide-react";
import { useState, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { api, ApiProblem } from "@/api/client";
import type { Run } from "@/api/types";
import { clock } from "@/design/clock";
import { isPlanned } from "./terms";
import { useUsualTime } from "./usualTime";
import styles from "./RunScreen.module.css";

/** How the run stands, which is read out when it changes, with its clock, which would be each second. */
export function RunPill({ run, elapsed_s, now }: { run: Run; elapsed_s: number; now: number }) {
  const { t } = useTranslation();
  const usual = useUsualTime(run, run.ended_at !== null);
  const planned = isPlanned(run, now);
  return (
    <span className={styles.pill} data-status={run.status}>
      <i aria-hidden="true" />{" "}
      <span role="status">{t(planned ? "run.terms.planned" : `run.status.${run.status}`)}</span>{" "}
      {planned ? null : <b>{clock(elapsed_s)}</b>}
      {planned || usual === null ? null : <small>{t("run.usual", { time: clock(usual) })}</small>}
    </span>
  );
}

interface RunActionsProps {
  run: Run;
  allowed: boolean;
  onProblem: (text: string | null) => void;
  onDone: () => void;
}

type Order = "pause" | "resume" | "cancel";

function useOrders({ run, onProblem, onDone }: RunActionsProps) {
  const [busy, setBusy] = useState(false);
  const send = (order: Order) => {
    setBusy(true);
    api
      .post(`/runs/${run.id}/${order}`)
      .then(() => onProblem(null))
      .catch((error: unknown) => {
        if (!(error instanceof ApiProblem)) throw error;
        onProblem(error.detail);
      })
      .finally(() => {
        setBusy(false);
        onDone();
      });
  };
  return { busy, send };
}

/** Pause, resume and cancel; where there is little room only those that can be pressed, on a tablet by their signs. */
export function RunActions(props: RunActionsProps) {
  const { t } = useTranslation();
  const [asking, setAsking] = useState(false);
  const { busy, send } = useOrders(props);
  const { run, allowed } = props;
  const paused = run.status === "paused";
  const order = (what: Order, icon: ReactNode, possible: boolean) => (
    <Button
      variant="default"
      className={`${styles.order} ${possible ? "" : styles.spare}`}
      title={t(`run.${what}`)}
      leftSection={icon}
      disabled={busy || !possible}
      onClick={() => send(what)}
    >
      <span className={styles.words}>{t(`run.${what}`)}</span>
    </Button>
  );
  if (["finished", "failed", "cancelled"].includes(run.status)) return <BackToEditor program={run.program.id} />;
  if (!allowed) return null;
  return (
    <>
      {order("pause", <Pause size={16} aria-hidden />, !paused)}
      {order("resume", <Play size={16} aria-hidden />, paused)}
      <Button
        variant="default"
        className={`${styles.order} ${styles.cancel}`}
        title={t("run.cancel")}
        leftSection={<X size={16} aria-hidden />}
        onClick={() => setAsking(true)}
      >
        <span className={styles.words}>{t("run.cancel")}</span>
      </Button>
      <CancelDialog opened={asking} onClose={() => setAsking(false)} onCancel={() => send("cancel")} />
    </>
  );
}

/** What comes after a run: its program, to be changed or run again. */
function BackToEditor({ program }: { program: string }) {
  const { t } = useTranslation();
  return (
    <Button
      component={Link}
      to={`/programs/${program}`}
      variant="default"
      leftSection={<ArrowLeft size={16} aria-hidden />}
    >
      {t("simulation.backToEditor")}
    </Button>
  );
}

interface CancelDialogProps {
  opened: boolean;
  onClose: () => void;
  onCancel: () => void;
}

function CancelDialog({ opened, onClose, onCancel }: CancelDialogProps) {
  const { t } = useTranslation();
  const cancel = () => {
    onClose();
    onCancel();
  };
  return (
    <Modal opened={opened} onClose={onClose} title={t("run.cancelTitle")} centered>
      <Text size="sm">{t("run.cancelText")}</Text>
      <Group justify="flex-end" mt="lg">
        <Button variant="default" onClick={onClose}>
          {t("run.goOn")}
        </Button>
        <Button color="red" onClick={cancel}>
          {t("run.cancel")}
        </Button>
      </Group>
    </Modal>
  );
}
