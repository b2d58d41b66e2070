/** A thread: what it is about, what was written, and what one may do with it. */
import { Button } from "@mantine/core";
import { Check, RotateCcw } from "lucide-react";
import { useEffect, useRef, useState, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import type { Thread } from "@/api/types";
import { mayComment } from "@/api/roles";
import { formatMoment } from "@/i18n/format";
import { problemText } from "../LoadProblem";
import { CommentForm } from "./CommentForm";
import classes from "./comments.module.css";
import { useDraft } from "./drafts";
import { piecesOf } from "./mentions";
import { useTalk } from "./talk";
import { useCommenting } from "./threads";

type Comment = Thread["comments"][number];

interface ThreadCardProps {
  thread: Thread;
  me: number | undefined;
  /** What it is about, in words. */
  about: string;
  /** The same as it stands at its head, if it leads anywhere or has more to say. */
  aboutLine?: ReactNode;
  /** It was opened by its pin. */
  opened: boolean;
  /** The keyboard goes to it. */
  isFirst: boolean;
}

/** What is done in a thread; a refusal is shown for a moment. */
function useActs() {
  const { t } = useTranslation();
  const { program, tell } = useTalk();
  const act = useCommenting(program);
  const refused = (problem: unknown) => tell(problemText(problem, t("shell.problem.screen")));
  return { act, now: (done: Promise<unknown>) => void done.catch(refused) };
}

export function ThreadCard({ thread, me, about, aboutLine, opened, isFirst }: ThreadCardProps) {
  const { act, now } = useActs();
  const { t } = useTranslation();
  const card = useInSight(isFirst);
  const writes = mayComment(useTalk().role);
  return (
    <li ref={card} className={classes.thread} aria-label={about} tabIndex={-1} data-opened={opened || undefined}>
      <div className={classes.head}>
        {aboutLine ?? <span className={classes.about}>{about}</span>}
        {thread.unread > 0 ? (
          <Button size="compact-xs" variant="light" onClick={() => now(act.markRead(thread.id))}>
            {t("comments.markRead", { count: thread.unread })}
          </Button>
        ) : null}
        {writes ? (
          <Button
            size="compact-xs"
            variant="default"
            leftSection={
              thread.resolved_at ? <RotateCcw size={12} aria-hidden="true" /> : <Check size={12} aria-hidden="true" />
            }
            onClick={() => now(act.resolve(thread.id, !thread.resolved_at))}
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
      {writes ? <Answer thread={thread.id} /> : null}
    </li>
  );
}

/** A thread that was opened by its pin is brought into sight, with the keyboard. */
function useInSight(isFirst: boolean) {
  const card = useRef<HTMLLIElement>(null);
  useEffect(() => {
    if (!isFirst) return;
    card.current?.scrollIntoView({ block: "nearest" });
    card.current?.focus({ preventScroll: true });
  }, [isFirst]);
  return card;
}

/** Whether a form is open: since it was asked for, or since something is being written in it. */
function useForm(draft: string) {
  const [asked, setAsked] = useState(false);
  const { isBegun } = useDraft(draft);
  return { draft, isOpen: asked || isBegun, quiet: !asked, setAsked };
}

/** A button that opens the form; it closes once the answer is sent, or when it is not wanted. */
function Answer({ thread }: { thread: string }) {
  const { t } = useTranslation();
  const { act } = useActs();
  const { draft, isOpen, quiet, setAsked } = useForm(`thread/${thread}`);
  if (isOpen)
    return (
      <CommentForm
        draft={draft}
        quiet={quiet}
        label={t("comments.answer")}
        send={t("comments.send")}
        onSend={(words) => act.answer(thread, words)}
        onDone={() => setAsked(false)}
      />
    );
  return (
    <div className={classes.acts}>
      <Button size="compact-xs" variant="subtle" onClick={() => setAsked(true)}>
        {t("comments.send")}
      </Button>
    </div>
  );
}

function Written({ comment, isMine }: { comment: Comment; isMine: boolean }) {
  const { t } = useTranslation();
  const { role } = useTalk();
  const { act, now } = useActs();
  const { draft, isOpen, quiet, setAsked } = useForm(`comment/${comment.id}`);
  const edit = isMine && mayComment(role);
  if (edit && isOpen)
    return (
      <li>
        <CommentForm
          draft={draft}
          quiet={quiet}
          label={t("comments.edit")}
          send={t("comments.save")}
          first={comment.text}
          onSend={(words) => act.edit(comment.id, words)}
          onDone={() => setAsked(false)}
        />
      </li>
    );
  return (
    <li>
      <div className={classes.who}>
        <b>{comment.author?.name ?? t("comments.nobody")}</b> {formatMoment(comment.written_at)}
        {comment.edited_at ? ` · ${t("comments.edited")}` : null}
        {edit ? (
          <Button size="compact-xs" variant="subtle" onClick={() => setAsked(true)}>
            {t("comments.edit")}
          </Button>
        ) : null}
        {edit || role === "admin" ? (
          <Button size="compact-xs" variant="subtle" onClick={() => now(act.remove(comment.id))}>
            {t("comments.delete")}
          </Button>
        ) : null}
      </div>
      <p className={classes.text}>
        {piecesOf(comment.text, comment.mentions).map(({ text, person }, at) =>
          person ? (
            <b key={at} className={classes.named}>
              {text}
            </b>
          ) : (
            text
          ),
        )}
      </p>
    </li>
  );
}
