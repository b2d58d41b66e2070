/** Run a version as it was, after a question. */
import { Button, Modal } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { useOnce } from "@/api/once";
import type { Program, RunSummary, Site, Version } from "@/api/types";
import { ReviewBeforeRun, useRunReview } from "@/shell/review/ReviewBeforeRun";
import { problemText } from "@/shell/LoadProblem";
import styles from "../pages.module.css";

interface RunProps {
  version: Version;
  program: Program;
  site: Site;
  onClose: () => void;
}

export function RunVersion({ version, program, site, onClose }: RunProps) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const begin = useOnce();
  const review = useRunReview(program.id, version.number);
  const run = useMutation({
    mutationFn: () =>
      begin<RunSummary>(`/programs/${program.id}/runs`, {
        version: version.number,
        ...(review.emergency ? { emergency: review.emergency } : {}),
      }),
    onSuccess: (started) => navigate(`/runs/${started.id}`),
  });
  const names = { name: program.name, number: version.number };
  return (
    <Modal opened onClose={onClose} title={t("history.run_ask", names)} size={440}>
      <div className={styles.form}>
        <p>{t("history.run_text")}</p>
        <ReviewBeforeRun program={program.id} version={version.number} role={site.role} state={review} />
        {run.isError ? <p role="alert">{problemText(run.error, t("shell.problem.screen"))}</p> : null}
        <div className={styles.buttons}>
          <Button variant="default" onClick={onClose}>
            {t("history.cancel")}
          </Button>
          <Button data-autofocus loading={run.isPending} disabled={!review.open} onClick={() => run.mutate()}>
            {t("history.run_it", names)}
          </Button>
        </div>
      </div>
    </Modal>
  );
}
