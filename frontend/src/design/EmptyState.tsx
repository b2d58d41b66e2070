import type { ReactNode } from "react";
import styles from "./parts.module.css";

interface EmptyStateProps {
  icon?: ReactNode;
  title: string;
  /** The element of the title: `h1` where nothing else heads the page. */
  as?: "p" | "h1";
  text?: string;
  /** One main action, one way out. */
  children?: ReactNode;
}

export function EmptyState({ icon, title, as: Title = "p", text, children }: EmptyStateProps) {
  return (
    <div className={styles.empty}>
      {icon ? <span className={styles.emptyIcon}>{icon}</span> : null}
      <Title className={styles.emptyTitle}>{title}</Title>
      {text ? <p className={styles.emptyText}>{text}</p> : null}
      {children ? <div className={styles.emptyActions}>{children}</div> : null}
    </div>
  );
}
