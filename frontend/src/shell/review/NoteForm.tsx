/** A sentence that goes with what somebody asks or says of a version. */
import { Button, Textarea } from "@mantine/core";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { problemText } from "../LoadProblem";
import styles from "./review.module.css";

interface NoteProps {
  label: string;
  send: string;
  /** Whether it says nothing without a sentence. */
  required?: boolean;
  busy: boolean;
  error: unknown;
  onSend: (note: string) => void;
  onCancel: () => void;
}

export function NoteForm({ label, send, required, busy, error, onSend, onCancel }: NoteProps) {
  const { t } = useTranslation();
  const [note, setNote] = useState("");
  const field = useRef<HTMLTextAreaElement>(null);
  useEffect(() => field.current?.focus(), []);
  return (
    <div className={styles.form}>
      <Textarea
        ref={field}
        label={label}
        autosize
        minRows={2}
        maxLength={500}
        required={required ?? false}
        value={note}
        onChange={(event) => setNote(event.currentTarget.value)}
      />
      {error ? (
        <p role="alert" className={styles.problem}>
          {problemText(error, t("shell.problem.screen"))}
        </p>
      ) : null}
      <div className={styles.buttons}>
        <Button
          size="xs"
          loading={busy}
          disabled={required === true && !note.trim()}
          onClick={() => onSend(note.trim())}
        >
          {send}
        </Button>
        <Button size="xs" variant="default" onClick={onCancel}>
          {t("review.cancel")}
        </Button>
      </div>
    </div>
  );
}
