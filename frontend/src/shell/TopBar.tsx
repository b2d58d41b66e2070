/** The bar of the full-screen places (editor, run, simulation): 52 px, Stop all always at its end. */
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { Logo } from "@/design/Logo";
import { ConnectionStrip } from "./ConnectionStrip";
import { LateBell } from "./admissions/LateBell";
import { AlertsBell } from "./alerts/AlertsBell";
import { FindingsStrip } from "./findings/FindingsStrip";
import { PaletteButton } from "./palette/PaletteButton";
import { QuestionsBell } from "./questions/QuestionsBell";
import { ReviewsBell } from "./review/ReviewsBell";
import { StopAllButton } from "./stop/StopAllButton";
import styles from "./shell.module.css";

interface TopBarProps {
  /** The site's slug, as soon as it is known. */
  site: string | undefined;
  /** Where we are: site / program / run. */
  crumbs?: ReactNode;
  /** Short facts behind the crumbs. */
  chips?: ReactNode;
  /** In the middle: undo and redo, or a run's state and clock. */
  children?: ReactNode;
  presence?: ReactNode;
  actions?: ReactNode;
}

export function TopBar({ site, crumbs, chips, children, presence, actions }: TopBarProps) {
  const { t } = useTranslation();
  return (
    <header className={styles.bar}>
      <div className={styles.barRow}>
        <Link to="/" className={styles.brand} aria-label={t("shell.brandHome")}>
          <Logo />
          <span>VIPO</span>
        </Link>
        {crumbs ? (
          <nav className={styles.crumbs} aria-label={t("shell.whereYouAre")}>
            {crumbs}
          </nav>
        ) : null}
        {chips ? <div className={`${styles.group} ${styles.facts}`}>{chips}</div> : null}
        <div className={styles.middle}>{children}</div>
        <div className={styles.spring} />
        <div className={styles.middle}>
          <PaletteButton slug={site} small />
        </div>
        {presence ? <div className={styles.presence}>{presence}</div> : null}
        {actions ? <div className={`${styles.group} ${styles.last}`}>{actions}</div> : null}
        {site ? <QuestionsBell slug={site} /> : null}
        {site ? <LateBell slug={site} /> : null}
        {site ? <ReviewsBell slug={site} /> : null}
        {site ? <AlertsBell slug={site} /> : null}
        {site ? <StopAllButton slug={site} /> : null}
      </div>
      {site ? <ConnectionStrip slug={site} /> : null}
      {site ? <FindingsStrip slug={site} /> : null}
    </header>
  );
}

/** One part of the crumbs; the last one is where we are. A name that is still being fetched is no link yet. */
export function Crumb({ to, children }: { to?: string; children: ReactNode }) {
  if (!children) return null;
  if (!to) return <span className={styles.crumbHere}>{children}</span>;
  return (
    <>
      <Link to={to} className={styles.crumb}>
        {children}
      </Link>
      <span className={styles.slash} aria-hidden="true">
        /
      </span>
    </>
  );
}
