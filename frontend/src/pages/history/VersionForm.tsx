/** Name and message of a version, typed at once or later. */
import { Button, Modal, Textarea, TextInput } from "@mantine/core";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { problemText } from "@/shell/LoadProblem";
import styles from "../pages.module.css";

export interface VersionWords {
  name: string;
  message: string;
}

interface FormProps {
  title: string;
  known?: VersionWords;
  busy: boolean;
  error: unknown;
  onSend: (words: VersionWords) => void;
  onClose: () => void;
}

export function VersionForm({ title, known, busy, error, onSend, onClose }: FormProps) {
  const { t } = useTranslation();
  const [name, setName] = useState(known?.name ?? "");
  const [message, setMessage] = useState(known?.message ?? "");
  const submit = (event: FormEvent) => {
    event.preventDefault();
    onSend({ name: name.trim(), message: message.trim() });
  };
  return (
    <Modal opened onClose={onClose} title={title} size={440}>
      <form onSubmit={submit} className={styles.form}>
        <TextInput
          data-autofocus
          label={t("history.name")}
          placeholder={t("history.name_example")}
          maxLength={80}
          value={name}
          onChange={(event) => setName(event.target.value)}
        />
        <Textarea
          label={t("history.message")}
          maxLength={300}
          autosize
          minRows={2}
          value={message}
          onChange={(event) => setMessage(event.target.value)}
        />
        {error ? <p role="alert">{problemText(error, t("shell.problem.screen"))}</p> : null}
        <div className={styles.buttons}>
          <Button variant="default" onClick={onClose}>
            {t("history.cancel")}
          </Button>
          <Button type="submit" loading={busy}>
            {t("history.keep")}
          </Button>
        </div>
      </form>
    </Modal>
  );
}
