/** Whether callers of a function must change something for its newer version, and what. */
import { useTranslation } from "react-i18next";
import type { FunctionReason } from "@/api/types";
import { Chip } from "@/design/Chip";
import { isBreaking, reasonWords } from "@/program/words/libraryWords";
import styles from "./functions.module.css";

export function FunctionVerdict({ reasons }: { reasons: readonly FunctionReason[] | undefined }) {
  const { t } = useTranslation();
  if (!reasons) return null;
  const breaks = isBreaking(reasons);
  return (
    <div className={styles.reasons}>
      <Chip tone={breaks ? "warn" : "done"}>{t(breaks ? "library.breaking" : "library.compatible")}</Chip>
      <ul>
        {reasons.length === 0 ? <li>{t("library.nothingElse")}</li> : null}
        {reasons.map((reason) => (
          <li key={`${reason.code}/${reason.name}`}>{reasonWords(t, reason)}</li>
        ))}
      </ul>
    </div>
  );
}
