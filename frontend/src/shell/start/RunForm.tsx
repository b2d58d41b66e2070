/** Run asks once: which robots, which checks; then the run's own screen opens. */
import { Button, Modal } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { TFunction } from "i18next";
import { type ReactNode, useState } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { useOnce } from "@/api/once";
import { keys, useDevices } from "@/api/queries";
import type { Run } from "@/api/types";
import { type Fact, FactList } from "@/design/FactList";
import { useTellUnseen } from "../refusal";
import { ReviewBeforeRun, useRunReview } from "../review/ReviewBeforeRun";
import { completed, type Given, Parameters } from "./Parameters";
import { RunTermsForm } from "./RunTermsForm";
import { termsToSend, USUAL } from "./runTerms";
import { robotsOf, type Startable } from "./startable";
import classes from "./start.module.css";

interface RunFormProps {
  about: Startable;
  /** So many errors and warnings the checks have found; null errors: nobody knows yet, the server decides. */
  errors: number | null;
  warnings: number;
  /** The parameters to begin with. */
  given?: Given;
  /** What else is known of what is run, before the other facts. */
  facts?: readonly Fact[];
  /** More ways to begin. */
  children?: ReactNode;
  onClose: () => void;
}

export function RunDialog({ opened, onClose, ...form }: RunFormProps & { opened: boolean }) {
  const { t } = useTranslation();
  return (
    <Modal opened={opened} onClose={onClose} title={t("start.run.title")}>
      <RunForm {...form} onClose={onClose} />
    </Modal>
  );
}

function RunForm(props: RunFormProps) {
  const { t } = useTranslation();
  const { about, onClose } = props;
  const { program, site, document, version } = about;
  const declared = Object.values(document.parameters);
  const [given, setGiven] = useState<Given>(props.given ?? {});
  const parameters = completed(declared, given);
  const [form, setForm] = useState(USUAL);
  const terms = termsToSend(form);
  const review = useRunReview(program.id, version);
  const run = useStartRun(about, parameters, terms, review.emergency, onClose);
  return (
    <div className={classes.content}>
      <p>{t(site.simulated ? "start.run.simulated" : "start.run.real", { program: program.name })}</p>
      <Facts {...props} />
      <Parameters {...about} parameters={declared} given={given} onGive={setGiven} />
      <RunTermsForm terms={form} onChange={setForm} />
      {props.children}
      <ReviewBeforeRun program={program.id} version={version} role={site.role} state={review} before={about.stored} />
      {run.error ? (
        <p className={classes.problem} role="alert">
          {run.error.message}
        </p>
      ) : null}
      <div className={classes.buttons}>
        <Button variant="default" onClick={onClose}>
          {t("editor.cancel")}
        </Button>
        <Button
          data-autofocus
          loading={run.isPending}
          disabled={(props.errors ?? 0) > 0 || parameters === null || terms === null || !review.open}
          onClick={() => run.mutate()}
        >
          {t(form.notBefore ? "start.run.plan" : "editor.run")}
        </Button>
      </div>
    </div>
  );
}

function useStartRun(
  { program, version, stored }: Startable,
  parameters: Given | null,
  terms: Record<string, string> | null,
  emergency: string,
  onStarted: () => void,
) {
  const navigate = useNavigate();
  const begin = useOnce();
  const queries = useQueryClient();
  const tellUnseen = useTellUnseen();
  return useMutation({
    mutationFn: async () => {
      await stored();
      return begin<Run>(`/programs/${program.id}/runs`, {
        parameters: parameters ?? {},
        ...(version === null ? {} : { version }),
        ...terms,
        ...(emergency ? { emergency } : {}),
      });
    },
    onSuccess: (started) => {
      onStarted();
      void navigate(`/runs/${started.id}`);
    },
    onError: (error) => {
      tellUnseen(error);
      // What was known before may be what it was refused for.
      return queries.invalidateQueries({ queryKey: keys.reviews });
    },
  });
}

/** Who will do it, and what speaks against it. */
function Facts({ about, errors, warnings, facts = [] }: RunFormProps) {
  const { t } = useTranslation();
  const { stop, slug } = about.site;
  const standIns = (useDevices(slug).data ?? []).filter((device) => device.stand_in);
  const simulated = standIns.map((device) => device.name).join(", ");
  const robots = robotsOf(about).map(({ role, robot }): Fact => ({
    tone: "robot",
    text: `${role ?? t("editor.role.default")}: ${robot ?? t("editor.role.any")}`,
  }));
  return (
    <FactList
      facts={[
        ...facts,
        ...robots,
        ...(simulated ? [{ tone: "warn", text: t("start.run.standIns", { devices: simulated }) } as const] : []),
        ...(errors === null ? [] : [checkFact(errors, t)]),
        ...(warnings > 0 ? [{ tone: "warn", text: t("start.run.warnings", { count: warnings }) } as const] : []),
        ...(stop.active ? [{ tone: "error", text: t("start.run.stopped", { by: stop.by ?? "?" }) } as const] : []),
      ]}
    />
  );
}

function checkFact(errors: number, t: TFunction): Fact {
  if (errors > 0) return { tone: "error", text: t("start.run.errors", { count: errors }) };
  return { tone: "done", text: t("start.run.checked") };
}
