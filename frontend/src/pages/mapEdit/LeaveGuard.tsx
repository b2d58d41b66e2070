/** Nobody leaves changes of a map behind without being asked. */
import { Button, Modal } from "@mantine/core";
import { useEffect } from "react";
import { useTranslation } from "react-i18next";
import { useBlocker } from "react-router-dom";
import styles from "./mapEdit.module.css";

export function LeaveGuard({ isOn }: { isOn: boolean }) {
  const { t } = useTranslation();
  const blocker = useBlocker(isOn);
  useEffect(() => {
    if (!isOn) return;
    const ask = (event: BeforeUnloadEvent) => event.preventDefault();
    window.addEventListener("beforeunload", ask);
    return () => window.removeEventListener("beforeunload", ask);
  }, [isOn]);
  if (blocker.state !== "blocked") return null;
  return (
    <Modal opened onClose={() => blocker.reset()} title={t("mapEdit.leaveAsk")} size={440}>
      <div className={styles.dialog}>
        <p>{t("mapEdit.leaveText")}</p>
        <div className={styles.decide}>
          <Button variant="default" onClick={() => blocker.reset()} data-autofocus>
            {t("mapEdit.stay")}
          </Button>
          <Button color="red" onClick={() => blocker.proceed()}>
            {t("mapEdit.leave")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}
