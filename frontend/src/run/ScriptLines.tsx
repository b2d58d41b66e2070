import type { Compiled } from "@/api/types";
import styles from "./RunScreen.module.css";

interface ScriptLinesProps {
  compiled: Compiled;
  lit: ReadonlySet<string>;
  selected: string | null;
  label: string;
  onSelect: (step: string) => void;
}

/** The script that runs, with the lines of the steps under way lit. */
export function ScriptLines({ compiled, lit, selected, label, onSelect }: ScriptLinesProps) {
  const lines = compiled.script.replace(/\n$/, "").split("\n");
  return (
    <ol className={styles.script} aria-label={label}>
      {lines.map((text, index) => {
        const step = compiled.lines[index] ?? "";
        return (
          // A script's lines do not move while it runs; the index is the line's name.
          <li
            key={index}
            data-lit={lit.has(step) || undefined}
            data-selected={(step && step === selected) || undefined}
          >
            <span className={styles.lineNumber}>{index + 1}</span>
            {step ? (
              <button type="button" className={styles.gutter} onClick={() => onSelect(step)}>
                {compiled.numbers[step] ?? ""}
              </button>
            ) : (
              <span />
            )}
            <code>{text}</code>
          </li>
        );
      })}
    </ol>
  );
}
