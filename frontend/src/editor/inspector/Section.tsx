/** A part of the program's panel under its own heading. */
import type { ReactNode } from "react";
import classes from "./inspector.module.css";

export function Section({ title, note, children }: { title: string; note?: string; children: ReactNode }) {
  return (
    <section className={classes.section} aria-label={title}>
      <h3>{title}</h3>
      {note ? <p className={classes.now}>{note}</p> : null}
      {children}
    </section>
  );
}
