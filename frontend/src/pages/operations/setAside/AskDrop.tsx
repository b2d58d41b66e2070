/** Before something that was set aside is dropped: what is lost with it. */
import { Button, Modal } from "@mantine/core";
import { useTranslation } from "react-i18next";
import type { DeadLetter } from "@/api/types";
import { useFocusAfter } from "@/design/useReturnFocus";
import pages from "../../pages.module.css";
import { lossWords, whatWords } from "./letterWords";

interface AskDropProps {
  letter: DeadLetter;
  busy: boolean;
  onDrop: () => void;
  onClose: () => void;
  /** Who has the focus when the dialog is gone. */
  afterwards: () => HTMLElement | null;
}

export function AskDrop({ letter, busy, onDrop, onClose, afterwards }: AskDropProps) {
  const { t } = useTranslation();
  useFocusAfter(afterwards);
  return (
    <Modal opened onClose={onClose} title={t("operations.setAside.dropAsk")} size={460} returnFocus={false}>
      <div className={pages.form}>
        <p className={pages.strong}>{whatWords(letter)}</p>
        <p>{`${lossWords(letter)} ${t("operations.setAside.noWayBack")}`}</p>
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose} data-autofocus>
            {t("operations.setAside.keep")}
          </Button>
          <Button color="red.9" loading={busy} onClick={onDrop}>
            {t("operations.setAside.drop")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}
