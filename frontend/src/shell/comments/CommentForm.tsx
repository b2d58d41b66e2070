/** A comment to write. */
import { Button } from "@mantine/core";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { WordsToWrite } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import classes from "./comments.module.css";
import { MentionField } from "./MentionField";
import { mentionedIn } from "./mentions";
import { useTalk } from "./talk";
import { usePeopleToMention } from "./threads";

interface CommentFormProps {
  label: string;
  send: string;
  first?: string;
  onSend: (words: WordsToWrite) => Promise<unknown>;
  /** It was sent, or is not wanted. */
  onDone: () => void;
}

/** It has the keyboard when it opens; what was refused stays in it, with the reason. */
export function CommentForm({ label, send, first = "", onSend, onDone }: CommentFormProps) {
  const { t } = useTranslation();
  const people = usePeopleToMention(useTalk().program).data ?? [];
  const [text, setText] = useState(first);
  const [busy, setBusy] = useState(false);
  const [refused, setRefused] = useState<string | null>(null);
  const field = useRef<HTMLTextAreaElement>(null);
  const form = useRef<HTMLFormElement>(null);
  useEffect(() => {
    field.current?.focus();
    form.current?.scrollIntoView({ block: "nearest" });
  }, []);
  const empty = text.trim() === "";
  const submit = async () => {
    if (empty || busy) return;
    setBusy(true);
    try {
      await onSend({ text: text.trim(), mentions: mentionedIn(text, people) });
      onDone();
    } catch (problem) {
      setRefused(problemText(problem, t("shell.problem.screen")));
      setBusy(false);
    }
  };
  return (
    <form
      ref={form}
      className={classes.form}
      onSubmit={(event) => {
        event.preventDefault();
        void submit();
      }}
    >
      <MentionField
        label={label}
        value={text}
        people={people}
        field={field}
        onChange={setText}
        onSubmit={() => void submit()}
        onLeave={onDone}
      />
      {refused === null ? null : <p role="alert">{refused}</p>}
      <div className={classes.acts}>
        <Button type="submit" size="xs" disabled={empty || busy}>
          {send}
        </Button>
        <Button size="xs" variant="default" onClick={onDone}>
          {t("comments.cancel")}
        </Button>
      </div>
    </form>
  );
}
