/** A thread: what it is about, what was written, and what one may do with it. */
import { Button } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import type { Thread, WordsToWrite } from "@/api/types";
import { mayComment } from "@/api/roles";
import { formatMoment } from "@/i18n/format";
import { useOpenProgram } from "../state/context";
import { say, select } from "../state/ui";
import { aboutOf } from "./about";
import { CommentForm } from "./CommentForm";
import classes from "./comments.module.css";
import { useCommenting, usePeopleToMention } from "./threads";

type Comment = Thread["comments"][number];

function tell(problem: unknown): void {
  say(problem instanceof Error ? problem.message : String(problem));
}

export function ThreadCard({ thread, me }: { thread: Thread; me: number | undefined }) {
  const { t } = useTranslation();
  const open = useOpenProgram();
  const { program, site } = open;
  const act = useCommenting(program.id);
  const writes = mayComment(site.role);
  const about = aboutOf(open, thread);
  return (
    <li className={classes.thread} aria-label={about}>
      <div className={classes.head}>
        <About thread={thread} about={about} />
        {thread.unread > 0 ? (
          <Button size="compact-xs" variant="light" onClick={() => void act.markRead(thread.id).catch(tell)}>
            {t("comments.markRead", { count: thread.unread })}
          </Button>
        ) : null}
        {writes ? (
          <Button
            size="compact-xs"
            variant="default"
            onClick={() => void act.resolve(thread.id, !thread.resolved_at).catch(tell)}
          >
            {t(thread.resolved_at ? "comments.reopen" : "comments.resolve")}
          </Button>
        ) : null}
      </div>
      <ol className={classes.comments}>
        {thread.comments.map((each) => (
          <Written key={each.id} comment={each} isMine={me !== undefined && each.author?.id === me} />
        ))}
      </ol>
      {writes ? <Answer onSend={(words) => act.answer(thread.id, words)} /> : null}
    </li>
  );
}

/** A button that opens the form; it closes once the answer is sent, or when it is not wanted. */
function Answer({ onSend }: { onSend: (words: WordsToWrite) => Promise<unknown> }) {
  const { t } = useTranslation();
  const [opened, setOpened] = useState(false);
  return (
    <div className={classes.answer}>
      {opened ? (
        <CommentForm
          label={t("comments.answer")}
          send={t("comments.send")}
          focused
          onSend={onSend}
          onDone={() => setOpened(false)}
        />
      ) : null}
      <Button size="compact-xs" variant="subtle" aria-expanded={opened} onClick={() => setOpened(!opened)}>
        {t(opened ? "comments.cancel" : "comments.send")}
      </Button>
    </div>
  );
}

function About({ thread, about }: { thread: Thread; about: string }) {
  const { t } = useTranslation();
  const { anchor, stands } = thread;
  const step = anchor.kind === "construct" && anchor.root === "steps" && stands ? anchor.id : null;
  if (step)
    return (
      <button type="button" className={classes.about} onClick={() => select([step])}>
        {about}
      </button>
    );
  return (
    <span className={classes.about}>
      {about}
      {stands ? null : <em> {t("comments.deleted")}</em>}
    </span>
  );
}

function Written({ comment, isMine }: { comment: Comment; isMine: boolean }) {
  const { t } = useTranslation();
  const { program, site } = useOpenProgram();
  const act = useCommenting(program.id);
  const [edits, setEdits] = useState(false);
  const writes = mayComment(site.role);
  return (
    <li className={classes.comment}>
      <p className={classes.who}>
        <b>{comment.author?.name ?? t("comments.nobody")}</b> {formatMoment(comment.written_at)}
        {comment.edited_at ? ` · ${t("comments.edited")}` : null}
      </p>
      {edits ? (
        <CommentForm
          label={t("comments.edit")}
          send={t("comments.save")}
          first={comment}
          focused
          onSend={(words) => act.edit(comment.id, words)}
          onDone={() => setEdits(false)}
        />
      ) : (
        <>
          <p className={classes.text}>{comment.text}</p>
          <Mentioned ids={comment.mentions} />
        </>
      )}
      <div className={classes.acts}>
        {isMine && writes ? (
          <Button size="compact-xs" variant="subtle" onClick={() => setEdits(!edits)}>
            {t(edits ? "comments.cancel" : "comments.edit")}
          </Button>
        ) : null}
        {(isMine && writes) || site.role === "admin" ? (
          <Button size="compact-xs" variant="subtle" onClick={() => void act.remove(comment.id).catch(tell)}>
            {t("comments.delete")}
          </Button>
        ) : null}
      </div>
    </li>
  );
}

function Mentioned({ ids }: { ids: readonly number[] }) {
  const { t, i18n } = useTranslation();
  const people = usePeopleToMention(useOpenProgram().program.id).data ?? [];
  const names = people.flatMap((each) => (each && ids.includes(each.id) ? [each.name] : []));
  if (names.length === 0) return null;
  const list = new Intl.ListFormat(i18n.language, { type: "conjunction" }).format(names);
  return <p className={classes.who}>{t("comments.mentioned", { names: list })}</p>;
}
