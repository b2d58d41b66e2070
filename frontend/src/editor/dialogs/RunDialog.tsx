/** Run asks once: which robots, which checks; then the run's own screen opens. */
import { Button, Modal } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import { Bot, CircleCheck, OctagonAlert, TriangleAlert } from "lucide-react";
import { type ReactNode, useState } from "react";
import { useNavigate } from "react-router-dom";
import { useOnce } from "@/api/once";
import { ReviewBeforeRun, useRunReview } from "@/shell/review/ReviewBeforeRun";
import type { Run } from "@/api/types";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import classes from "./dialogs.module.css";
import { Arm } from "../parts/Arm";
import { completed, type Given, RunParameters } from "./RunParameters";
import { RunTermsForm } from "./RunTermsForm";
import { termsToSend, USUAL } from "./runTerms";
import { roleOfStep } from "@/program/operation";

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
  const { t, program, site, document, shared } = useOpenProgram();
  const [given, setGiven] = useState<Given>({});
  const parameters = completed(Object.values(document.parameters), given);
  const [form, setForm] = useState(USUAL);
  const terms = termsToSend(form);
  const review = useRunReview(program.id, null);
  const run = useStartRun(parameters, terms, review.emergency, onClose);
  const { errors } = useProblemCounts();
  return (
    <div className={classes.content}>
      <p>{t(site.simulated ? "run_dialog.simulated" : "run_dialog.real", { program: program.name })}</p>
      <Facts />
      <RunParameters given={given} onGive={setGiven} />
      <RunTermsForm terms={form} onChange={setForm} />
      <Arm />
      <ReviewBeforeRun
        program={program.id}
        version={null}
        role={site.role}
        state={review}
        before={() => shared.stored()}
      />
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
          disabled={errors > 0 || parameters === null || terms === null || !review.open}
          onClick={() => run.mutate()}
        >
          {t(form.notBefore ? "run_dialog.plan" : "run")}
        </Button>
      </div>
    </div>
  );
}

function useStartRun(
  parameters: Given | null,
  terms: Record<string, string> | null,
  emergency: string,
  onStarted: () => void,
) {
  const { program, shared } = useOpenProgram();
  const navigate = useNavigate();
  const begin = useOnce();
  return useMutation({
    mutationFn: async () => {
      await shared.stored();
      return begin<Run>(`/programs/${program.id}/runs`, {
        parameters: parameters ?? {},
        ...terms,
        ...(emergency ? { emergency } : {}),
      });
    },
    onSuccess: (started) => {
      onStarted();
      void navigate(`/runs/${started.id}`);
    },
  });
}

function useProblemCounts() {
  const { diagnostics } = useOpenProgram();
  const errors = diagnostics.filter((each) => each.severity === "error").length;
  return { errors, warnings: diagnostics.length - errors };
}

/** Who will do it, and what speaks against it. */
function Facts() {
  const { t, site } = useOpenProgram();
  const { errors, warnings } = useProblemCounts();
  return (
    <ul className={classes.facts}>
      {useRobotLines().map((line) => (
        <li key={line}>
          <Bot size={16} aria-hidden="true" />
          {line}
        </li>
      ))}
      <Fact tone={errors > 0 ? "error" : "done"}>
        {errors > 0 ? t("run_dialog.errors", { count: errors }) : t("run_dialog.checked")}
      </Fact>
      {warnings > 0 ? <Fact tone="warn">{t("run_dialog.warnings", { count: warnings })}</Fact> : null}
      {site.stop.active ? <Fact tone="error">{t("run_dialog.stopped", { by: site.stop.by ?? "?" })}</Fact> : null}
    </ul>
  );
}

const SIGNS = { done: CircleCheck, warn: TriangleAlert, error: OctagonAlert } as const;

function Fact({ tone, children }: { tone: keyof typeof SIGNS; children: ReactNode }) {
  const Sign = SIGNS[tone];
  return (
    <li data-tone={tone}>
      <Sign size={16} aria-hidden="true" />
      {children}
    </li>
  );
}

/** "Robot: any robot that can do it", one for each role that a step uses. */
function useRobotLines(): readonly string[] {
  const { document, surroundings, t } = useOpenProgram();
  const roles = new Set<string>();
  for (const step of Object.values(document.steps)) if (roleOfStep(step) !== null) roles.add(roleOfStep(step) ?? "");
  return [...roles].map((id) => {
    const role = document.roles[id];
    const robot = role?.device ? (surroundings.devices.get(role.device)?.name ?? role.device) : t("role.any");
    return `${role?.name ?? t("role.default")}: ${robot}`;
  });
}
