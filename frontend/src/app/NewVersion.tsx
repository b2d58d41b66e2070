/** Says that the server has a newer page than this one. */
import { Button } from "@mantine/core";
import { RefreshCw } from "lucide-react";
import { useState, useSyncExternalStore } from "react";
import { useTranslation } from "react-i18next";
import { isOld, onOld } from "@/offline/register";
import styles from "./newVersion.module.css";

export function NewVersion() {
  const { t } = useTranslation();
  const old = useSyncExternalStore(onOld, isOld);
  const [later, setLater] = useState(false);
  const shown = old && !later;
  return (
    <div role="status">
      {shown ? (
        <div className={styles.note}>
          <RefreshCw size={16} aria-hidden="true" />
          <p>{t("shell.version.text")}</p>
          <Button size="xs" onClick={() => location.reload()}>
            {t("shell.version.reload")}
          </Button>
          <Button size="xs" variant="default" onClick={() => setLater(true)}>
            {t("shell.version.later")}
          </Button>
        </div>
      ) : null}
    </div>
  );
}
