/** The drawer at the bottom: script, problems, steps, tests, comments. */
import {
  ChevronsDown,
  ChevronsUp,
  Copy,
  FileCode2,
  FlaskConical,
  ListTree,
  MessageSquare,
  OctagonAlert,
  PanelBottomClose,
  PanelBottomOpen,
} from "lucide-react";
import { lazy, type ReactNode, Suspense } from "react";
import { IconButton } from "@/design/IconButton";
import { useTranslation } from "react-i18next";
import { countUnread, useThreads } from "@/shell/comments/threads";
import { useOpenProgram } from "../state/context";
import { say, showTab, useUi, type DrawerTab } from "../state/ui";
import classes from "./drawer.module.css";

/** What it shows, and what the inspector shows of a program: the map does not wait for it. */
export const loadDrawer = () => import("./DrawerBody");
const DrawerBody = lazy(async () => ({ default: (await loadDrawer()).DrawerBody }));

export function Drawer({ small }: { small: boolean }) {
  const { t, diagnostics } = useOpenProgram();
  const drawer = useUi((ui) => ui.drawer);
  const tall = useUi((ui) => ui.tallDrawer);
  return (
    <section
      className={classes.drawer}
      data-tour="drawer"
      data-tall={tall || undefined}
      data-open={drawer.open || undefined}
      aria-label={t("drawer.label")}
    >
      <div className={classes.bar}>
        <div role="tablist" aria-label={t("drawer.label")} className={classes.tabs}>
          <Tab tab="script" icon={<FileCode2 size={15} aria-hidden="true" />} label={t("drawer.script")} />
          <Tab
            tab="problems"
            icon={<OctagonAlert size={15} aria-hidden="true" />}
            label={t("drawer.problems")}
            count={diagnostics.length}
          />
          <Tab tab="steps" icon={<ListTree size={15} aria-hidden="true" />} label={t("drawer.steps")} />
          <Tab tab="tests" icon={<FlaskConical size={15} aria-hidden="true" />} label={t("drawer.tests")} />
          <CommentsTab />
        </div>
        <Actions />
      </div>
      {drawer.open ? (
        <div className={classes.body} role="tabpanel" id="drawer-panel" aria-labelledby={`drawer-tab-${drawer.tab}`}>
          <Suspense fallback={<div aria-busy="true" />}>
            <DrawerBody tab={drawer.tab} beside={!small && drawer.tab === "script"} />
          </Suspense>
        </div>
      ) : null}
    </section>
  );
}

function Actions() {
  const { t, compiled } = useOpenProgram();
  const drawer = useUi((ui) => ui.drawer);
  const toggle = () => useUi.setState({ drawer: { ...drawer, open: !drawer.open } });
  const copy = () => void navigator.clipboard.writeText(compiled?.script ?? "").then(() => say(t("script.copied")));
  const Sign = drawer.open ? PanelBottomClose : PanelBottomOpen;
  return (
    <div className={classes.actions}>
      {drawer.open && drawer.tab === "script" ? (
        <IconButton label={t("script.copy")} onClick={copy}>
          <Copy size={15} aria-hidden="true" />
        </IconButton>
      ) : null}
      {drawer.open ? <Height /> : null}
      <IconButton label={t(drawer.open ? "drawer.hide" : "drawer.show")} aria-expanded={drawer.open} onClick={toggle}>
        <Sign size={16} aria-hidden="true" />
      </IconButton>
    </div>
  );
}

function Height() {
  const { t } = useOpenProgram();
  const tall = useUi((ui) => ui.tallDrawer);
  const Sign = tall ? ChevronsDown : ChevronsUp;
  return (
    <IconButton label={t("drawer.taller")} aria-pressed={tall} onClick={() => useUi.setState({ tallDrawer: !tall })}>
      <Sign size={16} aria-hidden="true" />
    </IconButton>
  );
}

function CommentsTab() {
  const { program } = useOpenProgram();
  const { t } = useTranslation();
  const unread = countUnread(useThreads(program.id).data ?? []);
  const icon = <MessageSquare size={15} aria-hidden="true" />;
  return <Tab tab="comments" icon={icon} label={t("comments.title")} count={unread} tone="news" />;
}

interface TabProps {
  tab: DrawerTab;
  icon: ReactNode;
  label: string;
  count?: number;
  /** What is counted: what is wrong, or what is new. */
  tone?: "wrong" | "news";
}

function Tab({ tab, icon, label, count = 0, tone = "wrong" }: TabProps) {
  const drawer = useUi((ui) => ui.drawer);
  const chosen = drawer.tab === tab && drawer.open;
  return (
    <button
      type="button"
      role="tab"
      id={`drawer-tab-${tab}`}
      aria-selected={chosen}
      aria-controls={chosen ? "drawer-panel" : undefined}
      className={classes.tab}
      onClick={() => showTab(tab)}
    >
      {icon}
      {label}
      {count > 0 ? (
        <span className={classes.count} data-tone={tone}>
          {count}
        </span>
      ) : null}
    </button>
  );
}
