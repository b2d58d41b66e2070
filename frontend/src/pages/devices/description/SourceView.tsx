import { tokenise, type Dialect } from "./source";
import styles from "./source.module.css";

/** Text in a fixed font with numbered lines and quiet colours. */
export function SourceView({ text, dialect, label }: { text: string; dialect: Dialect; label: string }) {
  const lines = text.replace(/\n+$/, "").split("\n");
  return (
    // A region that scrolls must be reachable by keyboard.
    <div className={styles.source} role="region" aria-label={label} tabIndex={0}>
      {lines.map((line, index) => (
        <div key={index} className={styles.line}>
          <span className={styles.number} aria-hidden="true">
            {index + 1}
          </span>
          <code>
            {tokenise(line, dialect).map((token, part) => (
              <span key={part} style={token.kind ? { color: `var(--c-${token.kind})` } : undefined}>
                {token.text}
              </span>
            ))}
          </code>
        </div>
      ))}
    </div>
  );
}
