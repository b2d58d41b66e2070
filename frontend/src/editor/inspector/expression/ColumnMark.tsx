/** A wavy line under the word of a text box that cannot be understood. */
import { useLayoutEffect, useState, type RefObject } from "react";
import classes from "./expression.module.css";
import { wordAt } from "./wordAt";

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
