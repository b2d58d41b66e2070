/** In the place of what is not there yet, or could not be fetched. */
import { Button, Loader } from "@mantine/core";
import { CloudOff } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { ApiProblem } from "@/api/client";
import { EmptyState } from "@/design/EmptyState";
import styles from "./shell.module.css";

/** The sentence of a refusal, which is in the language of the screen where we have words for it; else the fallback. */
export function problemText(error: unknown, fallback: string): string {
  return error instanceof ApiProblem ? error.message : fallback;
}

/** In the place of what could not be fetched: what happened, and another try. */
export function LoadProblem({ error, again }: { error: unknown; again?: () => void }) {
  const { t } = useTranslation();
  const closed = error instanceof ApiProblem && (error.status === 404 || error.status === 403);
  return (
    <div role="alert">
      <EmptyState
        icon={<CloudOff size={20} />}
        title={t("shell.problem.title")}
        text={problemText(error, t("shell.problem.screen"))}
      >
        {again ? (
          <Button variant="default" onClick={again}>
            {t("shell.problem.again")}
          </Button>
        ) : null}
        {closed ? (
          <Button component={Link} to="/">
            {t("shell.toHome")}
          </Button>
        ) : null}
      </EmptyState>
    </div>
  );
}

/** In the place of a page of a site whose member this person is no more. */
export function NoMember() {
  const { t } = useTranslation();
  return (
    <div role="alert">
      <EmptyState icon={<CloudOff size={20} />} title={t("shell.noMember.title")} text={t("shell.noMember.text")}>
        <Button component={Link} to="/">
          {t("shell.toHome")}
        </Button>
      </EmptyState>
    </div>
  );
}

export function Waiting() {
  const { t } = useTranslation();
  return (
    <div className={styles.waiting} role="status">
      <Loader size="sm" aria-hidden="true" />
      <span className="visually-hidden">{t("shell.loading")}</span>
    </div>
  );
}
