import type { ReactNode } from "react";
import styles from "./parts.module.css";
import { statusColour, StatusGlyph, type StatusName } from "./StatusGlyph";

/** A status as its sign and its word. */
export function StatusBadge({ status, size, children }: { status: StatusName; size?: number; children: ReactNode }) {
  return (
    <span className={styles.status} style={{ color: statusColour(status) }}>
      <StatusGlyph status={status} size={size} />
      {children}
    </span>
  );
}
