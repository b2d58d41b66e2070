/** The comments of a program: those that are open, mention me, or are resolved, and a new one. */
import { Button, SegmentedControl } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { LoadProblem } from "@/shell/LoadProblem";
import { useMe } from "@/api/queries";
import { mayComment } from "@/api/roles";
import type { ThreadToStart } from "@/api/types";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { stepLabel } from "./about";
import { CommentForm } from "./CommentForm";
import classes from "./comments.module.css";
import { ThreadCard } from "./ThreadCard";
import { FILTERS, filterThreads, useCommenting, useThreads, type Filter } from "./threads";

export function CommentsPanel() {
  const { t } = useTranslation();
  const { program, site } = useOpenProgram();
  const threads = useThreads(program.id);
  const me = useMe().data?.user?.id;
  const [filter, setFilter] = useState<Filter>("open");
  const shown = filterThreads(threads.data ?? [], filter, me);
  return (
    <div className={classes.panel}>
      <SegmentedControl
        size="xs"
        className={classes.filter}
        aria-label={t("comments.filter")}
        value={filter}
        data={FILTERS.map((value) => ({ value, label: t(`comments.show.${value}`) }))}
        onChange={(value) => setFilter(FILTERS.find((each) => each === value) ?? "open")}
      />
      {mayComment(site.role) ? <NewThread /> : null}
      {threads.error ? <LoadProblem error={threads.error} again={() => void threads.refetch()} /> : null}
      {threads.data && shown.length === 0 ? <p className={classes.none}>{t(`comments.none.${filter}`)}</p> : null}
      <ul className={classes.threads}>
        {shown.map((each) => (
          <ThreadCard key={each.id} thread={each} me={me} />
        ))}
      </ul>
    </div>
  );
}

/** About the step that is selected, or about the program. */
function NewThread() {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const act = useCommenting(program.id);
  const about = useAbout();
  const [opened, setOpened] = useState(false);
  const label = about.label ? t("comments.on", { what: about.label }) : t("comments.onProgram");
  return (
    <div className={classes.answer}>
      {opened ? (
        <CommentForm
          key={about.anchor.id ?? ""}
          label={label}
          send={t("comments.begin")}
          focused
          onSend={(words) => act.start({ ...words, ...about })}
          onDone={() => setOpened(false)}
        />
      ) : null}
      <Button size="compact-sm" variant="default" aria-expanded={opened} onClick={() => setOpened(!opened)}>
        {opened ? t("comments.cancel") : label}
      </Button>
    </div>
  );
}

function useAbout(): Pick<ThreadToStart, "anchor" | "label"> & { label: string } {
  const open = useOpenProgram();
  const selected = useUi((ui) => ui.selected);
  const [id] = selected;
  const label = selected.length === 1 && id !== undefined ? stepLabel(open, id) : null;
  if (label === null) return { anchor: { kind: "program" }, label: "" };
  return { anchor: { kind: "construct", root: "steps", id }, label };
}
