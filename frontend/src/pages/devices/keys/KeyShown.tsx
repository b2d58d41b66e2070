/** A device's new key, shown this one time. */
import { Button, Modal } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { SecretField } from "@/design/SecretField";
import { useFocusInList } from "../focus";
import styles from "./keys.module.css";
import { useShownKey, type ShownKey } from "./shownKey";

export function KeyShown() {
  const shown = useShownKey((state) => state.shown);
  return shown ? <KeyDialog shown={shown} /> : null;
}

function KeyDialog({ shown }: { shown: ShownKey }) {
  const { t } = useTranslation();
  const forget = useShownKey((state) => state.forget);
  useFocusInList(shown.device);
  return (
    <Modal
      opened
      onClose={forget}
      closeOnClickOutside={false}
      closeOnEscape={false}
      title={t("keys.shownTitle", { name: shown.name })}
      size={480}
    >
      <div className={styles.key}>
        <p>{t("keys.shownOnce")}</p>
        <SecretField label={t("keys.field")} value={shown.credential} copy={t("keys.copy")} copied={t("keys.copied")} />
        <p>{t(shown.taken ? "keys.taken" : "keys.notTaken")}</p>
        <Button onClick={forget}>{t("keys.close")}</Button>
      </div>
    </Modal>
  );
}
