/** What speaks for and against something, before it is done: facts with signs. */
import { Bot, CircleCheck, MessageSquare, OctagonAlert, TriangleAlert } from "lucide-react";
import styles from "./parts.module.css";

const SIGNS = {
  done: CircleCheck,
  warn: TriangleAlert,
  error: OctagonAlert,
  plain: MessageSquare,
  robot: Bot,
} as const;

export interface Fact {
  readonly tone: keyof typeof SIGNS;
  readonly text: string;
}

export function FactList({ facts, label }: { facts: readonly Fact[]; label?: string }) {
  return (
    <ul className={styles.facts} aria-label={label}>
      {facts.map(({ tone, text }) => {
        const Sign = SIGNS[tone];
        return (
          <li key={text} data-tone={tone}>
            <Sign size={16} aria-hidden="true" />
            {text}
          </li>
        );
      })}
    </ul>
  );
}
