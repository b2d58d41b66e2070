/** A device's new key, shown this one time. */
import { Button, Modal } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { SecretField } from "@/design/SecretField";
import { useFocusInList } from "../focus";
import styles from "./keys.module.css";
import { useShownKeys, type ShownKey } from "./shownKey";

export function KeyShown() {
  const [shown] = useShownKeys();
  return shown ? <KeyDialog key={shown.credential} shown={shown} /> : null;
}

const forget = () => useShownKeys.setState((all) => all.slice(1), true);

function KeyDialog({ shown }: { shown: ShownKey }) {
  const { t } = useTranslation();
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
