/** The constructs that a program uses, as a row of their icons. */
import { useTranslation } from "react-i18next";
import type { Program } from "@/api/types";
import { VipoIcon } from "@/design/VipoIcon";
import { kindOf, kindWordKey } from "@/program/kinds";
import styles from "./steps.module.css";

export function StepIcons({ kinds }: { kinds: Program["kinds"] }) {
  const { t } = useTranslation();
  return (
    <ul className={styles.kinds} aria-label={t("pages.stepsUsed")}>
      {kinds.slice(0, 8).map((kind) => {
        const { icon, family } = kindOf(kind);
        const name = t(kindWordKey(kind));
        return (
          <li key={kind} title={name} style={{ color: `var(--${family})` }}>
            <VipoIcon name={icon} size={15} />
            <span className="visually-hidden">{name}</span>
          </li>
        );
      })}
    </ul>
  );
}
