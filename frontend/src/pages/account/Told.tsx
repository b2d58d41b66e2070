/** What came of a form: why it was refused, or what was done. */
import { Check, CircleAlert } from "lucide-react";
import { useTranslation } from "react-i18next";
import { problemText } from "@/shell/LoadProblem";
import styles from "./account.module.css";

/** `done` is empty until it is. */
export function Told({ error, done }: { error: Error | null; done: string }) {
  const { t } = useTranslation();
  if (error)
    return (
      <p className={styles.refused} role="alert">
        <CircleAlert size={16} aria-hidden="true" />
        {problemText(error, t("shell.problem.screen"))}
      </p>
    );
  return (
    <p className={done ? styles.done : "visually-hidden"} role="status">
      {done ? <Check size={16} aria-hidden="true" /> : null}
      {done}
    </p>
  );
}
