/** Below the map of a run: its timeline, its whole journal, its script and the comments on its moments. */
import { Button } from "@mantine/core";
import { ChartGantt, FileCode, MessageSquare, MessageSquarePlus, SquareTerminal } from "lucide-react";
import { useCallback, useMemo, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import type { RunEvent } from "@/api/types";
import { clock } from "@/design/clock";
import { DEFAULT_ROLE, roleOfStep } from "@/program/operation";
import { countUnread } from "@/shell/comments/threads";
import { RunComments } from "./comments/RunComments";
import comments from "./comments/runComments.module.css";
import styles from "./RunScreen.module.css";
import { Journal } from "./RunSteps";
import { elapsedSeconds, type RunView, type Tab } from "./runView";
import { ScriptLines } from "./ScriptLines";
import { Timeline, TimelineLegend } from "./Timeline";

const TABS: { tab: Tab; icon: ReactNode }[] = [
  { tab: "timeline", icon: <ChartGantt size={15} aria-hidden /> },
  { tab: "logs", icon: <SquareTerminal size={15} aria-hidden /> },
  { tab: "script", icon: <FileCode size={15} aria-hidden /> },
  { tab: "comments", icon: <MessageSquare size={15} aria-hidden /> },
];

interface DrawerProps {
  tab: Tab;
  onTab: (tab: Tab) => void;
  /** How many comments wait to be read. */
  unread: number;
  /** At the right end of the tabs. */
  aside: ReactNode;
  children: ReactNode;
}

function Drawer(props: DrawerProps) {
  const { t } = useTranslation();
  return (
    <section className={styles.drawer} aria-label={t("run.drawer")}>
      <div className={styles.tabs}>
        <div role="tablist" aria-label={t("run.drawer")}>
          {TABS.map(({ tab, icon }) => (
            <button
              key={tab}
              type="button"
              role="tab"
              id={`run-tab-${tab}`}
              aria-selected={tab === props.tab}
              aria-controls="run-tab-body"
              onClick={() => props.onTab(tab)}
            >
              {icon} {t(`run.tab.${tab}`)}
              {tab === "comments" && props.unread > 0 ? (
                <span className={styles.unread} title={t("comments.run.unread", { count: props.unread })}>
                  <span aria-hidden="true">{props.unread}</span>
                  <span className="visually-hidden"> {t("comments.run.unread", { count: props.unread })}</span>
                </span>
              ) : null}
            </button>
          ))}
        </div>
        {props.aside}
      </div>
      <div className={styles.tabBody} role="tabpanel" id="run-tab-body" aria-labelledby={`run-tab-${props.tab}`}>
        {props.children}
      </div>
    </section>
  );
}

/** Timeline, whole journal, script or comments. */
export function RunDrawer({ view, tell }: { view: RunView; tell: (refusal: string) => void }) {
  const { t } = useTranslation();
  const { run, site, lines, journal, timeline, devices, over, numberOf, nameOf, setSelected, tab, setTab, comments } =
    view;
  const elapsed_s = elapsedSeconds(run, view.now);
  const lit = useMemo(
    () => new Set(lines.filter((line) => line.started_at && !line.ended_at).map((line) => line.step)),
    [lines],
  );
  const robotOf = useCallback(
    (step: string) => run.roles[roleOfStep(run.document.steps[step]) ?? DEFAULT_ROLE],
    [run.roles, run.document],
  );
  const unread = countUnread(comments.threads.map(({ thread }) => thread));
  return (
    <Drawer tab={tab} onTab={setTab} unread={unread} aside={tab === "timeline" ? <Aside view={view} /> : null}>
      {tab === "timeline" && (
        <Timeline
          {...{ timeline, devices, elapsed_s, over, numberOf, robotOf }}
          comments={{ ...comments, open: (thread) => (comments.open(thread), setTab("comments")) }}
          onSelect={setSelected}
          onWrite={(t_s) => view.write(view.aboutMoment(t_s))}
        />
      )}
      {tab === "logs" && (
        <Journal {...{ journal, numberOf, nameOf }} label={t("run.tab.logs")} full onWrite={writeOn(view)} />
      )}
      {tab === "script" && (
        <ScriptLines
          compiled={run.compiled}
          lit={lit}
          selected={view.selected}
          label={t("run.tab.script")}
          onSelect={setSelected}
        />
      )}
      {tab === "comments" && (
        <RunComments
          run={run}
          role={site?.role ?? "viewer"}
          comments={comments}
          about={view.aboutMoment(comments.moment ?? elapsed_s)}
          tell={tell}
          onMoment={(t_s) => {
            comments.setMoment(t_s);
            setTab("timeline");
          }}
        />
      )}
    </Drawer>
  );
}

/** What the bars mean; beside it, once a moment is chosen, the way to comment on it. */
function Aside({ view }: { view: RunView }) {
  const { t } = useTranslation();
  const { moment, allowed } = view.comments;
  return (
    <>
      {moment !== null && allowed ? (
        <Button
          className={comments.begin}
          size="compact-sm"
          variant="default"
          leftSection={<MessageSquarePlus size={14} aria-hidden="true" />}
          onClick={() => view.write(view.aboutMoment(moment))}
        >
          {t("comments.on", { what: clock(moment) })}
        </Button>
      ) : null}
      <TimelineLegend />
    </>
  );
}

/** Begins a comment on a line of the journal; nothing for those who may not. */
export function writeOn(view: RunView) {
  if (!view.comments.allowed) return null;
  return ({ t_s, step }: RunEvent) => view.write(view.aboutMoment(t_s, step || undefined));
}
