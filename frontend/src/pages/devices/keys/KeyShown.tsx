/** A device's new key, shown this one time. */
import { Button, CopyButton, Modal, TextInput } from "@mantine/core";
import { Check, Copy } from "lucide-react";
import { useTranslation } from "react-i18next";
import { create } from "zustand";
import { useFocusInList } from "../focus";
import styles from "./keys.module.css";

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
        <div className={styles.row}>
          <TextInput
            className={styles.field}
            classNames={{ input: styles.mono }}
            label={t("keys.field")}
            readOnly
            data-autofocus
            value={shown.credential}
            onFocus={(event) => event.currentTarget.select()}
          />
          <CopyButton value={shown.credential} timeout={4000}>
            {({ copied, copy }) => (
              <Button
                variant="default"
                onClick={copy}
                leftSection={copied ? <Check size={16} aria-hidden="true" /> : <Copy size={16} aria-hidden="true" />}
              >
                {t(copied ? "keys.copied" : "keys.copy")}
              </Button>
            )}
          </CopyButton>
        </div>
        <p>{t(shown.taken ? "keys.taken" : "keys.notTaken")}</p>
        <Button onClick={forget}>{t("keys.close")}</Button>
      </div>
    </Modal>
  );
}

export interface ShownKey {
  device: string;
  name: string;
  credential: string;
  taken: boolean;
}

interface ShownKeyStore {
  shown: ShownKey | null;
  show: (key: ShownKey) => void;
  forget: () => void;
}

export const useShownKey = create<ShownKeyStore>()((set) => ({
  shown: null,
  show: (shown) => set({ shown }),
  forget: () => set({ shown: null }),
}));
