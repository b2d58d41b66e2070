/** What was done, said in the corner, with a button that takes it back. */
import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import i18next from "i18next";
import { Undo2 } from "lucide-react";
import styles from "./undoNotice.module.css";

/** Long enough to be read and reached by keyboard. */
const SHOWN_MS = 20_000;

export function tellWithUndo(message: string, undo: () => void): void {
  const takeBack = () => {
    notifications.hide(id);
    undo();
  };
  const id = notifications.show({
    autoClose: SHOWN_MS,
    message: (
      <span className={styles.notice}>
        {message}
        <Button size="xs" variant="default" leftSection={<Undo2 size={14} aria-hidden="true" />} onClick={takeBack}>
          {i18next.t("floorCheck.remedy.undo")}
        </Button>
      </span>
    ),
  });
}
