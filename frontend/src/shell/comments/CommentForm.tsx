/** A comment to write. */
import { Button } from "@mantine/core";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { WordsToWrite } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import classes from "./comments.module.css";
import { useDraft } from "./drafts";
import { MentionField } from "./MentionField";
import { mentionedIn } from "./mentions";
import { useTalk } from "./talk";
import { usePeopleToMention } from "./threads";

interface CommentFormProps {
  /** Under this name the text is kept until it is sent or given up, whatever the screen shows meanwhile. */
  draft: string;
  label: string;
  send: string;
  first?: string;
  /** It has not been asked for just now, and leaves the keyboard where it is. */
  quiet?: boolean;
  onSend: (words: WordsToWrite) => Promise<unknown>;
  /** It was sent, or is not wanted. */
  onDone: () => void;
}

/** It has the keyboard when it opens; what was refused stays in it, with the reason. */
export function CommentForm({ draft, label, send, first, quiet = false, onSend, onDone }: CommentFormProps) {
  const { t } = useTranslation();
  const people = usePeopleToMention(useTalk().program).data ?? [];
  const { text, write, isSending, send: sendDraft, giveUp } = useDraft(draft, first);
  const [refused, setRefused] = useState<string | null>(null);
  const field = useRef<HTMLTextAreaElement>(null);
  const form = useRef<HTMLFormElement>(null);
  useEffect(() => {
    if (quiet) return;
    field.current?.focus();
    form.current?.scrollIntoView({ block: "nearest" });
  }, [quiet]);
  const empty = text.trim() === "";
  const submit = async () => {
    if (empty) return;
    try {
      if (await sendDraft(() => onSend({ text: text.trim(), mentions: mentionedIn(text, people) }))) onDone();
    } catch (problem) {
      setRefused(problemText(problem, t("shell.problem.screen")));
    }
  };
  const leave = () => {
    giveUp();
    onDone();
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
        onChange={write}
        onSubmit={() => void submit()}
        onLeave={leave}
      />
      {refused === null ? null : <p role="alert">{refused}</p>}
      <div className={classes.acts}>
        <Button type="submit" size="xs" disabled={empty || isSending}>
          {send}
        </Button>
        <Button size="xs" variant="default" onClick={leave}>
          {t("comments.cancel")}
        </Button>
      </div>
    </form>
  );
}
