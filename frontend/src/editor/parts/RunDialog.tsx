/** Run asks once: which robots, which checks; then the run's own screen opens. */
import { Button, Modal } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import { Bot, CircleCheck, OctagonAlert, TriangleAlert } from "lucide-react";
import { useState } from "react";
import { useNavigate } from "react-router-dom";
import { api } from "@/api/client";
import type { Run } from "@/api/types";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import classes from "./dialogs.module.css";
import { completed, RunParameters, type Given } from "./RunParameters";

export function RunDialog() {
  const { t } = useOpenProgram();
  const opened = useUi((ui) => ui.dialog === "run");
  const close = () => useUi.setState({ dialog: null });
  return (
    <Modal opened={opened} onClose={close} title={t("run_dialog.title")}>
      <Content onClose={close} />
    </Modal>
  );
}

function Content({ onClose }: { onClose: () => void }) {
  const { t, program, site, diagnostics, document } = useOpenProgram();
  const navigate = useNavigate();
  const [given, setGiven] = useState<Given>({});
  const parameters = completed(Object.values(document.parameters), given);
  const errors = diagnostics.filter((each) => each.severity === "error").length;
  const warnings = diagnostics.length - errors;
  const run = useMutation({
    mutationFn: () => api.post<Run>(`/programs/${program.id}/runs`, { parameters: parameters ?? {} }),
    onSuccess: (started) => {
      onClose();
      void navigate(`/runs/${started.id}`);
    },
  });
  const lines = useRobotLines();
  return (
    <div className={classes.content}>
      <p>{t(site.simulated ? "run_dialog.simulated" : "run_dialog.real", { program: program.name })}</p>
      <ul className={classes.facts}>
        {lines.map((line) => (
          <li key={line}>
            <Bot size={16} aria-hidden="true" />
            {line}
          </li>
        ))}
        <li data-tone={errors > 0 ? "error" : "done"}>
          {errors > 0 ? <OctagonAlert size={16} aria-hidden="true" /> : <CircleCheck size={16} aria-hidden="true" />}
          {errors > 0 ? t("run_dialog.errors", { count: errors }) : t("run_dialog.checked")}
        </li>
        {warnings > 0 ? (
          <li data-tone="warn">
            <TriangleAlert size={16} aria-hidden="true" />
            {t("run_dialog.warnings", { count: warnings })}
          </li>
        ) : null}
        {site.stop.active ? (
          <li data-tone="error">
            <OctagonAlert size={16} aria-hidden="true" />
            {t("run_dialog.stopped", { by: site.stop.by ?? "?" })}
          </li>
        ) : null}
      </ul>
      <RunParameters given={given} onGive={setGiven} />
      {run.error ? (
        <p className={classes.problem} role="alert">
          {run.error.message}
        </p>
      ) : null}
      <div className={classes.buttons}>
        <Button variant="default" onClick={onClose}>
          {t("cancel")}
        </Button>
        <Button
          data-autofocus
          loading={run.isPending}
          disabled={errors > 0 || parameters === null}
          onClick={() => run.mutate()}
        >
          {t("run")}
        </Button>
      </div>
    </div>
  );
}

/** "Robot: any robot that can do it", one for each role that a step uses. */
function useRobotLines(): readonly string[] {
  const { document, surroundings, t } = useOpenProgram();
  const roles = new Set<string>();
  for (const step of Object.values(document.steps))
    if (["move", "pick", "drop", "pick_and_drop"].includes(step.kind)) roles.add(String(step.params.role ?? "robot"));
  return [...roles].map((id) => {
    const role = document.roles[id];
    const robot = role?.device ? (surroundings.devices.get(role.device)?.name ?? role.device) : t("role.any");
    return `${role?.name ?? t("role.default")}: ${robot}`;
  });
}
