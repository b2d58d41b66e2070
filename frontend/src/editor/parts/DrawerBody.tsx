/** What stands in the drawer at the bottom: the panel of the chosen tab, and beside the script what is wrong. */
import { lazy, Suspense } from "react";
import type { DrawerTab } from "../state/ui";
import classes from "./drawer.module.css";
import { ProblemsPanel } from "./ProblemsPanel";
import { ScriptPanel } from "./ScriptPanel";
import { StepTree } from "./StepTree";

const CommentsPanel = lazy(async () => ({ default: (await import("../comments/CommentsPanel")).CommentsPanel }));

export function DrawerBody({ tab, beside }: { tab: DrawerTab; beside: boolean }) {
  return (
    <div className={classes.body} role="tabpanel" id="drawer-panel" aria-labelledby={`drawer-tab-${tab}`}>
      {tab === "script" ? <ScriptPanel /> : null}
      {tab === "problems" ? <ProblemsPanel /> : null}
      {tab === "steps" ? <StepTree /> : null}
      {tab === "comments" ? (
        <Suspense fallback={null}>
          <CommentsPanel />
        </Suspense>
      ) : null}
      {beside ? (
        <div className={classes.beside}>
          <ProblemsPanel titled />
        </div>
      ) : null}
    </div>
  );
}
