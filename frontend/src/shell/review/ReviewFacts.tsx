/** What is said of a program's content, as a list of facts with signs. */
import { CircleCheck, MessageSquare, OctagonAlert, TriangleAlert } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { Fact } from "./review";
import styles from "./review.module.css";

const SIGNS = { done: CircleCheck, warn: TriangleAlert, error: OctagonAlert, plain: MessageSquare } as const;

export function ReviewFacts({ facts }: { facts: readonly Fact[] }) {
  const { t } = useTranslation();
  return (
    <ul className={styles.facts} aria-label={t("review.title")}>
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
