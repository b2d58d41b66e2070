/** The frame of the management pages: side bar, title bar with Stop all, page, and a pane for details. */
import { useEffect, type ReactNode } from "react";
import { useSiteLive } from "@/live/site";
import { LateBell } from "./admissions/LateBell";
import { AlertsBell } from "./alerts/AlertsBell";
import { ConnectionStrip } from "./ConnectionStrip";
import { useCurrentSite } from "./currentSite";
import { FactorStrip } from "./FactorStrip";
import { FindingsStrip } from "./findings/FindingsStrip";
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
  const { slug } = useCurrentSite();
  useSiteLive(slug);
  useEffect(() => {
    document.title = `${title} · VIPO`;
  }, [title]);
  return (
    <div className={styles.shell} data-manage="">
      <SideBar />
      <header className={styles.head}>
        <div className={styles.headRow}>
          <h1 className={styles.title}>{title}</h1>
          <div className={styles.chips}>{chips}</div>
          <div className={styles.spring} />
          <div className={styles.actions}>{actions}</div>
          {slug ? <QuestionsBell slug={slug} /> : null}
          {slug ? <LateBell slug={slug} /> : null}
          {slug ? <ReviewsBell slug={slug} /> : null}
          {slug ? <AlertsBell slug={slug} /> : null}
          {slug ? <StopAllButton slug={slug} /> : null}
        </div>
        {slug ? <ConnectionStrip slug={slug} /> : null}
        {slug ? <FindingsStrip slug={slug} /> : null}
        {slug ? <FactorStrip slug={slug} /> : null}
      </header>
      <main className={styles.page}>{children}</main>
      {detail ? <div className={styles.detail}>{detail}</div> : null}
    </div>
  );
}
