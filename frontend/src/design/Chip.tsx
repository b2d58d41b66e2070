import type { ReactNode } from "react";
import styles from "./parts.module.css";

export type Tone =
  | "quiet"
  | "plain"
  | "brand"
  | "machine"
  | "logic"
  | "note"
  | "pend"
  | "error"
  | "warn"
  | "done"
  | "busy";

/** A short fact in a tinted box. */
export function Chip({ tone = "quiet", mono, children }: { tone?: Tone; mono?: boolean; children: ReactNode }) {
  return (
    <span className={styles.chip} data-tone={tone} data-mono={mono || undefined}>
      {children}
    </span>
  );
}
