/** A robot that waits to be let into a zone, with what lets it in; who may not do that sees that it waits. */
import { Button, Group } from "@mantine/core";
import { Bot } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useLetIn } from "@/api/admissions";
import type { AwaitedAdmission } from "@/api/types";
import { problemText } from "../LoadProblem";
import { OpenZoneMenu } from "./OpenZoneMenu";
import styles from "../questions/questions.module.css";

interface AdmissionCardProps {
  slug: string;
  awaited: AwaitedAdmission;
  /** Whether the reader may let robots in. */
  allowed: boolean;
  /** Whether it leads to the run that the robot works for. */
  leads?: boolean;
  /** Told when its menu opens and when it is gone. */
  onMenu?: (open: boolean) => void;
}

export function AdmissionCard({ slug, awaited, allowed, leads = false, onMenu }: AdmissionCardProps) {
  const { t } = useTranslation();
  const letIn = useLetIn(slug);
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState("");
  const open = () => {
    setBusy(true);
    setProblem("");
    void letIn(awaited)
      .catch((error: unknown) => setProblem(problemText(error, t("shell.problem.screen"))))
      .finally(() => setBusy(false));
  };
  const names = { robot: awaited.robot_name, zone: awaited.zone_name };
  return (
    <section className={styles.card} data-state="open" aria-label={t("admission.title")}>
      <p className={styles.head}>
        <Bot size={15} aria-hidden />
        {leads && awaited.run ? <Link to={`/runs/${awaited.run}`}>{t("admission.to_run")}</Link> : t("admission.title")}
      </p>
      <p className={styles.text}>{t("admission.text", names)}</p>
      {allowed ? (
        <Group gap={8}>
          <Button size="compact-md" loading={busy} onClick={open} aria-label={t("admission.let_in", names)}>
            {t("admission.let")}
          </Button>
          <OpenZoneMenu slug={slug} zone={awaited.zone} name={awaited.zone_name} onMenu={onMenu} />
        </Group>
      ) : (
        <p className={styles.note}>{t("admission.waits")}</p>
      )}
      {problem ? (
        <p className={styles.problem} role="alert">
          {problem}
        </p>
      ) : null}
    </section>
  );
}
