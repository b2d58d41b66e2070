/** What stands in the drawer at the bottom: the panel of the chosen tab, and beside the script what is wrong. */
import { lazy, Suspense } from "react";
import { loadScreenTexts } from "@/i18n";
import type { DrawerTab } from "../state/ui";
import classes from "./drawer.module.css";
import { ProblemsPanel } from "./ProblemsPanel";
import { ScriptPanel } from "./ScriptPanel";
import { StepTree } from "./StepTree";

/** Fetched when it is opened, with its texts. */
const TestsPanel = lazy(async () => {
  const [panel] = await Promise.all([import("../tests/TestsPanel"), loadScreenTexts()]);
  return { default: panel.TestsPanel };
});
const CommentsPanel = lazy(async () => ({ default: (await import("../comments/CommentsPanel")).CommentsPanel }));

export function DrawerBody({ tab, beside }: { tab: DrawerTab; beside: boolean }) {
  return (
    <>
      {tab === "script" ? <ScriptPanel /> : null}
      {tab === "problems" ? <ProblemsPanel /> : null}
      {tab === "steps" ? <StepTree /> : null}
      <Suspense fallback={null}>
        {tab === "tests" ? <TestsPanel /> : null}
        {tab === "comments" ? <CommentsPanel /> : null}
      </Suspense>
      {beside ? (
        <div className={classes.beside}>
          <ProblemsPanel titled />
        </div>
      ) : null}
    </>
  );
}
