/** The comments on moments of a run: those that are open, mention me, or are resolved, and a new one. */
import { Button, SegmentedControl } from "@mantine/core";
import { MessageSquarePlus } from "lucide-react";
import { useMemo, useState, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useMe } from "@/api/queries";
import type { Role, Run, Thread } from "@/api/types";
import { clock } from "@/design/clock";
import { CommentForm } from "@/shell/comments/CommentForm";
import classes from "@/shell/comments/comments.module.css";
import { TalkContext } from "@/shell/comments/talk";
import { ThreadCard } from "@/shell/comments/ThreadCard";
import { FILTERS, filterThreads, type Filter } from "@/shell/comments/threads";
import { LoadProblem } from "@/shell/LoadProblem";
import styles from "./runComments.module.css";
import type { AboutMoment, RunComments as Comments } from "./useRunComments";

interface RunCommentsProps {
  run: Run;
  role: Role;
  comments: Comments;
  /** What a comment is about that is begun without choosing a moment. */
  about: AboutMoment;
  tell: (refusal: string) => void;
  /** Show a moment on the timeline. */
  onMoment: (t_s: number) => void;
}

export function RunComments({ run, role, comments, about, tell, onMoment }: RunCommentsProps) {
  const { t } = useTranslation();
  const { program } = run;
  const talk = useMemo(() => ({ program: program.id, role, tell }), [program.id, role, tell]);
  if (comments.isGone) return <p className={styles.gone}>{t("comments.run.gone")}</p>;
  return (
    <TalkContext value={talk}>
      <div className={styles.panel}>
        <Shown run={run.id} comments={comments} onMoment={onMoment}>
          {comments.allowed && comments.writing === null ? (
            <Button
              size="compact-sm"
              variant="default"
              leftSection={<MessageSquarePlus size={14} aria-hidden="true" />}
              onClick={() => comments.setWriting(about)}
            >
              {t("comments.on", { what: clock(about.t_s) })}
            </Button>
          ) : null}
          <Link className={styles.program} to={`/programs/${program.id}`}>
            {t("comments.run.program")}
          </Link>
        </Shown>
      </div>
    </TalkContext>
  );
}

interface ShownProps {
  run: string;
  comments: Comments;
  onMoment: (t_s: number) => void;
  children: ReactNode;
}

function Shown({ run, comments, onMoment, children }: ShownProps) {
  const { t } = useTranslation();
  const me = useMe().data?.user?.id;
  const { query, threads, opened } = comments;
  const [filter, setFilter] = useState<Filter>("open");
  const all = threads.map(({ thread }) => thread);
  const isOpened = opened !== null && all.some(({ id }) => id === opened);
  const shown = isOpened
    ? all.filter((each) => !each.resolved_at || each.id === opened)
    : filterThreads(all, filter, me);
  return (
    <>
      <div className={classes.head}>
        <SegmentedControl
          size="xs"
          aria-label={t("comments.filter")}
          value={isOpened ? "open" : filter}
          data={FILTERS.map((value) => ({ value, label: t(`comments.show.${value}`) }))}
          onChange={(value) => {
            if (opened !== null) comments.open(null);
            setFilter(FILTERS.find((each) => each === value) ?? "open");
          }}
        />
        {children}
      </div>
      <NewThread draft={`run/${run}`} comments={comments} />
      {query.error ? <LoadProblem error={query.error} again={() => void query.refetch()} /> : null}
      {query.data && shown.length === 0 ? <p className={classes.none}>{t(`comments.run.none.${filter}`)}</p> : null}
      <ul className={classes.threads}>
        {shown.map((each) => (
          <Card key={each.id} thread={each} me={me} comments={comments} onMoment={onMoment} />
        ))}
      </ul>
    </>
  );
}

interface CardProps {
  thread: Thread;
  me: number | undefined;
  comments: Comments;
  onMoment: (t_s: number) => void;
}

function Card({ thread, me, comments, onMoment }: CardProps) {
  const at = thread.anchor.t_s ?? 0;
  const about = [clock(at), thread.label].filter(Boolean).join(" · ");
  const opened = thread.id === comments.opened;
  const line = (
    <button type="button" className={classes.about} onClick={() => onMoment(at)}>
      {about}
    </button>
  );
  return <ThreadCard thread={thread} me={me} about={about} aboutLine={line} opened={opened} isFirst={opened} />;
}

/** What is being written stays in the form when another moment is chosen. */
function NewThread({ draft, comments }: { draft: string; comments: Comments }) {
  const { t } = useTranslation();
  const { writing } = comments;
  if (!writing || !comments.allowed) return null;
  const what = [clock(writing.t_s), writing.label].filter(Boolean).join(" · ");
  return (
    <CommentForm
      key={writing.t_s}
      draft={draft}
      label={t("comments.on", { what })}
      send={t("comments.begin")}
      onSend={(words) => comments.begin({ ...words, ...writing })}
      onDone={() => comments.setWriting((now) => (now?.t_s === writing.t_s ? null : now))}
    />
  );
}
