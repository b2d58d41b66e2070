/** The comments of a program: those that are open, mention me, or are resolved, and a new one. */
import { Button, SegmentedControl, Switch } from "@mantine/core";
import { MessageSquarePlus } from "lucide-react";
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { CommentForm } from "@/shell/comments/CommentForm";
import talkClasses from "@/shell/comments/comments.module.css";
import { TalkContext } from "@/shell/comments/talk";
import { ThreadCard } from "@/shell/comments/ThreadCard";
import { FILTERS, filterThreads, useCommenting, useThreads, type Filter } from "@/shell/comments/threads";
import { LoadProblem } from "@/shell/LoadProblem";
import { useMe } from "@/api/queries";
import { mayComment } from "@/api/roles";
import { selection } from "../commands/command";
import { useOpenProgram } from "../state/context";
import { say, useUi } from "../state/ui";
import { aboutFrom, aboutOf, type About } from "./about";
import { AboutLine } from "./AboutLine";
import classes from "./comments.module.css";
import { useComments, writeAbout } from "./commentsUi";

export function CommentsPanel() {
  const { program, site } = useOpenProgram();
  const talk = useMemo(() => ({ program: program.id, role: site.role, tell: say }), [program.id, site.role]);
  return (
    <TalkContext value={talk}>
      <Threads />
    </TalkContext>
  );
}

function Threads() {
  const { t } = useTranslation();
  const open = useOpenProgram();
  const { program, site } = open;
  const threads = useThreads(program.id);
  const me = useMe().data?.user?.id;
  const opened = useComments((ui) => ui.opened);
  const [filter, setFilter] = useState<Filter>("open");
  const shown = filterThreads(threads.data ?? [], opened.length > 0 ? "open" : filter, me);
  const choose = (value: string) => {
    useComments.setState({ opened: [] });
    setFilter(FILTERS.find((each) => each === value) ?? "open");
  };
  return (
    <div className={classes.panel}>
      <div className={talkClasses.head}>
        <SegmentedControl
          size="xs"
          className={classes.filter}
          aria-label={t("comments.filter")}
          value={opened.length > 0 ? "open" : filter}
          data={FILTERS.map((value) => ({ value, label: t(`comments.show.${value}`) }))}
          onChange={choose}
        />
        <PinSwitch />
        {mayComment(site.role) ? <Begin /> : null}
      </div>
      <NewThread />
      {threads.error ? <LoadProblem error={threads.error} again={() => void threads.refetch()} /> : null}
      {threads.data && shown.length === 0 ? <p className={talkClasses.none}>{t(`comments.none.${filter}`)}</p> : null}
      <ul className={talkClasses.threads}>
        {shown.map((each) => {
          const about = aboutOf(open, each);
          return (
            <ThreadCard
              key={each.id}
              thread={each}
              me={me}
              about={about}
              aboutLine={<AboutLine thread={each} about={about} />}
              opened={opened.includes(each.id)}
              isFirst={each.id === opened[0]}
            />
          );
        })}
      </ul>
    </div>
  );
}

function PinSwitch() {
  const { t } = useTranslation();
  const pins = useComments((ui) => ui.pins);
  return (
    <Switch
      size="xs"
      label={t("comments.pins")}
      checked={pins}
      onChange={(event) => useComments.setState({ pins: event.currentTarget.checked })}
    />
  );
}

/** Opens the form: about the step that is selected, or about the program. */
function Begin() {
  const { t } = useTranslation();
  const open = useOpenProgram();
  const writing = useComments((ui) => ui.writing !== null);
  useUi((ui) => ui.selected);
  const about = aboutFrom(open, selection());
  if (writing) return null;
  return (
    <Button
      size="compact-sm"
      variant="default"
      leftSection={<MessageSquarePlus size={14} aria-hidden="true" />}
      onClick={() => writeAbout(about)}
    >
      {titleOf(about, t)}
    </Button>
  );
}

function titleOf({ label }: About, t: (key: string, values?: Record<string, string>) => string): string {
  return label === "" ? t("comments.onProgram") : t("comments.on", { what: label });
}

/** What is being written stays in the form when another thing is chosen that it is about. */
function NewThread() {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const act = useCommenting(program.id);
  const about = useComments((ui) => ui.writing);
  if (!about) return null;
  return (
    <CommentForm
      key={JSON.stringify(about.anchor)}
      draft={`program/${program.id}`}
      label={titleOf(about, t)}
      send={t("comments.begin")}
      onSend={(words) => act.start({ ...words, ...about })}
      onDone={() => useComments.setState((ui) => (ui.writing === about ? { writing: null } : ui))}
    />
  );
}
