import { Skeleton } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { Panel } from "@/design/Panel";
import styles from "./pages.module.css";

/** The place of a table that is on its way. */
export function TableSkeleton({ rows = 6 }: { rows?: number }) {
  const { t } = useTranslation();
  return (
    <Panel className={styles.skeleton} role="status" aria-label={t("shell.loading")}>
      {Array.from({ length: rows }, (_, index) => (
        <Skeleton key={index} height={20} radius="sm" />
      ))}
    </Panel>
  );
}
