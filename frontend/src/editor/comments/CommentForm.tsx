/** A comment to write, with the members whom it mentions. */
import { Button, MultiSelect, Textarea } from "@mantine/core";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { WordsToWrite } from "@/api/types";
import { say } from "../state/ui";
import { useOpenProgram } from "../state/context";
import classes from "./comments.module.css";
import { usePeopleToMention } from "./threads";

const MOST_TEXT = 4000;
const MOST_MENTIONS = 20;

interface CommentFormProps {
  label: string;
  send: string;
  first?: WordsToWrite;
  /** Takes the keyboard when it opens: for forms that somebody asked for. */
  focused?: boolean;
  onSend: (words: WordsToWrite) => Promise<unknown>;
  onDone?: () => void;
}

export function CommentForm({ label, send, first, focused, onSend, onDone }: CommentFormProps) {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const people = usePeopleToMention(program.id);
  const [text, setText] = useState(first?.text ?? "");
  const [mentions, setMentions] = useState((first?.mentions ?? []).map(String));
  const field = useRef<HTMLTextAreaElement>(null);
  useEffect(() => {
    if (focused) field.current?.focus();
  }, [focused]);
  const [busy, setBusy] = useState(false);
  const submit = async () => {
    setBusy(true);
    try {
      await onSend({ text: text.trim(), mentions: mentions.map(Number) });
      setText("");
      setMentions([]);
      onDone?.();
    } catch (problem) {
      say(problem instanceof Error ? problem.message : String(problem));
    } finally {
      setBusy(false);
    }
  };
  const data = (people.data ?? []).flatMap((each) => (each ? [{ value: String(each.id), label: each.name }] : []));
  return (
    <form
      className={classes.form}
      onSubmit={(event) => {
        event.preventDefault();
        void submit();
      }}
    >
      <Textarea
        label={label}
        value={text}
        ref={field}
        maxLength={MOST_TEXT}
        autosize
        minRows={1}
        maxRows={6}
        onChange={(event) => setText(event.currentTarget.value)}
      />
      <MultiSelect
        label={t("comments.mention")}
        data={data}
        value={mentions}
        maxValues={MOST_MENTIONS}
        searchable
        size="xs"
        onChange={setMentions}
      />
      <Button type="submit" size="xs" disabled={text.trim() === "" || busy}>
        {send}
      </Button>
    </form>
  );
}
