/** A button that asks others to review a version, with a note. */
import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { NoteForm } from "./NoteForm";
import { useAskForReview } from "./review";
import styles from "./review.module.css";

interface AskProps {
  program: string;
  /** Null: what is drawn now, which becomes a version. */
  version: number | null;
  before?: () => Promise<void>;
}

export function AskForReview({ program, version, before }: AskProps) {
  const { t } = useTranslation();
  const [open, setOpen] = useState(false);
  const ask = useAskForReview(program, version, before);
  if (!open)
    return (
      <Button className={styles.ask} size="xs" variant="default" onClick={() => setOpen(true)}>
        {t("review.ask")}
      </Button>
    );
  const send = (note: string) =>
    ask.mutate(note, {
      onSuccess: ({ number }) => {
        setOpen(false);
        notifications.show({ message: t("review.is_asked", { number }) });
      },
    });
  return (
    <NoteForm
      label={t("review.ask_note")}
      send={t("review.send")}
      busy={ask.isPending}
      error={ask.error}
      onSend={send}
      onCancel={() => setOpen(false)}
    />
  );
}
