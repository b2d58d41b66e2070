/** The frame of the management pages: side bar, title bar with Stop all, page, and a pane for details. */
import { type ReactNode } from "react";
import { useSiteLive } from "@/live/site";
import { useTitle } from "./useTitle";
import { LateBell } from "./admissions/LateBell";
import { AlertsBell } from "./alerts/AlertsBell";
import { ConnectionStrip } from "./ConnectionStrip";
import { useCurrentSite } from "./currentSite";
import { FactorStrip } from "./FactorStrip";
import { FindingsStrip } from "./findings/FindingsStrip";
import { NoMember } from "./LoadProblem";
import { QuestionsBell } from "./questions/QuestionsBell";
import { ReviewsBell } from "./review/ReviewsBell";
import { SideBar } from "./SideBar";
import { StopAllButton } from "./stop/StopAllButton";
import styles from "./shell.module.css";

interface PageShellProps {
  title: string;
  /** Short facts behind the title. */
  chips?: ReactNode;
  actions?: ReactNode;
  /** The pane at the right, 544 px; a sheet on small screens. */
  detail?: ReactNode;
  children: ReactNode;
}

export function PageShell({ title, chips, actions, detail, children }: PageShellProps) {
  const { slug, open } = useCurrentSite();
  const isClosed = open !== slug;
  useSiteLive(slug);
  useTitle(title);
  return (
    <div className={styles.shell} data-manage="">
      <SideBar />
      <header className={styles.head}>
        <div className={styles.headRow}>
          <h1 className={styles.title}>{title}</h1>
          <div className={styles.chips}>{isClosed ? null : chips}</div>
          <div className={styles.spring} />
          <div className={styles.actions}>{isClosed ? null : actions}</div>
          {open ? <QuestionsBell slug={open} /> : null}
          {open ? <LateBell slug={open} /> : null}
          {open ? <ReviewsBell slug={open} /> : null}
          {open ? <AlertsBell slug={open} /> : null}
          {open ? <StopAllButton slug={open} /> : null}
        </div>
        {open ? <ConnectionStrip slug={open} /> : null}
        {open ? <FindingsStrip slug={open} /> : null}
        {open ? <FactorStrip slug={open} /> : null}
      </header>
      <main className={styles.page}>{isClosed ? <NoMember /> : children}</main>
      {detail && !isClosed ? <div className={styles.detail}>{detail}</div> : null}
    </div>
  );
}
