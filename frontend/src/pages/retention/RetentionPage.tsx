/** How long a site keeps what has ended, what takes how many bytes, and what is in the archive; for admins. */
import { useTranslation } from "react-i18next";
import type { Retention } from "@/api/types";
import { SettingsPage } from "../settings/SettingsPage";
import { PATH } from "./retention";
import { ArchiveTable, ProgramTable } from "./Tables";
import { Times } from "./Times";
import styles from "./retention.module.css";

export function RetentionPage() {
  const { t } = useTranslation();
  return (
    <SettingsPage<Retention> path={PATH} title={t("retention.title")} notForYou={t("retention.notForYou")}>
      {(retention, slug) => (
        <>
          {retention.trouble ? (
            <p className={styles.trouble} role="status">
              {t("retention.trouble", { why: retention.trouble })}
            </p>
          ) : null}
          <Times slug={slug} retention={retention} />
          <ProgramTable retention={retention} />
          <ArchiveTable retention={retention} />
        </>
      )}
    </SettingsPage>
  );
}
