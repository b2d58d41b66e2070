import { Button, Group, Modal, Text } from "@mantine/core";
import { Pause, Play, X } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { api, ApiProblem } from "@/api/client";
import type { Run } from "@/api/types";
import { clock } from "@/design/clock";
import styles from "./RunScreen.module.css";

/** How the run stands, with its clock. */
export function RunPill({ run, elapsed_s }: { run: Run; elapsed_s: number }) {
  const { t } = useTranslation();
  return (
    <span className={styles.pill} data-status={run.status} role="status">
      <i aria-hidden="true" /> {t(`run.status.${run.status}`)} <b>{clock(elapsed_s)}</b>
    </span>
  );
}

interface RunActionsProps {
  run: Run;
  allowed: boolean;
  onProblem: (text: string | null) => void;
  onDone: () => void;
}

/** Pause, resume and cancel. */
export function RunActions({ run, allowed, onProblem, onDone }: RunActionsProps) {
  const { t } = useTranslation();
  const [asking, setAsking] = useState(false);
  const [busy, setBusy] = useState(false);
  const over = ["finished", "failed", "cancelled"].includes(run.status);
  const send = (what: "pause" | "resume" | "cancel") => {
    setBusy(true);
    api
      .post(`/runs/${run.id}/${what}`)
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
  if (over || !allowed) return null;
  return (
    <>
      <Button
        variant="default"
        leftSection={<Pause size={16} />}
        disabled={busy || run.status === "paused"}
        onClick={() => send("pause")}
      >
        {t("run.pause")}
      </Button>
      <Button
        variant="default"
        leftSection={<Play size={16} />}
        disabled={busy || run.status !== "paused"}
        onClick={() => send("resume")}
      >
        {t("run.resume")}
      </Button>
      <Button variant="default" className={styles.cancel} leftSection={<X size={16} />} onClick={() => setAsking(true)}>
        {t("run.cancel")}
      </Button>
      <Modal opened={asking} onClose={() => setAsking(false)} title={t("run.cancelTitle")} centered>
        <Text size="sm">{t("run.cancelText")}</Text>
        <Group justify="flex-end" mt="lg">
          <Button variant="default" onClick={() => setAsking(false)}>
            {t("run.goOn")}
          </Button>
          <Button
            color="red"
            onClick={() => {
              setAsking(false);
              send("cancel");
            }}
          >
            {t("run.cancel")}
          </Button>
        </Group>
      </Modal>
    </>
  );
}
