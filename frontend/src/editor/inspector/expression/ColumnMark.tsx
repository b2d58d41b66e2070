/** A wavy line under the word of a text box that cannot be understood. */
import { type RefObject, useLayoutEffect, useState } from "react";
import classes from "./expression.module.css";

interface ColumnMarkProps {
  input: RefObject<HTMLInputElement | null>;
  text: string;
  /** Counted from 1. */
  column: number;
  /** How far the text is scrolled to the left, px. */
  scrolled: number;
}

export function ColumnMark({ input, text, column, scrolled }: ColumnMarkProps) {
  const [inset, setInset] = useState(0);
  useLayoutEffect(() => {
    const box = input.current;
    if (box) setInset(box.clientLeft + parseFloat(getComputedStyle(box).paddingLeft));
  }, [input]);
  return (
    <span className={classes.mark} style={{ left: inset, right: inset }} aria-hidden="true">
      <span style={{ marginLeft: -scrolled }}>
        {text.slice(0, column - 1)}
        <u>{wordAt(text, column)}</u>
      </span>
    </span>
  );
}

export function wordAt(text: string, column: number): string {
  const rest = text.slice(column - 1);
  return /^[\p{L}\p{N}_.]+/u.exec(rest)?.[0] ?? (rest.charAt(0).trim() || "\u00a0");
}
