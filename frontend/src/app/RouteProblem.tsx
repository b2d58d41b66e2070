/** An address without a screen, or a screen that broke. */
import { Button } from "@mantine/core";
import { Compass } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link, useRouteError } from "react-router-dom";
import { EmptyState } from "@/design/EmptyState";
import styles from "@/shell/shell.module.css";

export function RouteProblem() {
  const { t } = useTranslation();
  const error = useRouteError();
  const what = error ? "broken" : "lost";
  return (
    <main className={styles.waiting} role={error ? "alert" : undefined}>
      <EmptyState icon={<Compass size={20} />} as="h1" title={t(`shell.${what}.title`)} text={t(`shell.${what}.text`)}>
        {error ? <Button onClick={() => location.reload()}>{t("shell.broken.reload")}</Button> : null}
        <Button component={Link} to="/" reloadDocument={Boolean(error)} variant={error ? "default" : "filled"}>
          {t("shell.toHome")}
        </Button>
      </EmptyState>
    </main>
  );
}
