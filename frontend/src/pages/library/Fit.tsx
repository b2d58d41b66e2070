/** Whether the devices of the site that is open can do what a function needs, and what they lack. */
import { Check, TriangleAlert } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { LibraryFunction } from "@/api/types";
import { Panel } from "@/design/Panel";
import { lackWords, needWords } from "@/program/words/libraryWords";
import styles from "./library.module.css";

export function FitLine({ item }: { item: LibraryFunction }) {
  const { t } = useTranslation();
  if (!item.lacks) return null;
  const fits = item.lacks.length === 0;
  const Sign = fits ? Check : TriangleAlert;
  return (
    <span className={styles.fit} data-fits={fits}>
      <Sign size={14} aria-hidden="true" />
      <span>{fits ? t("library.fits") : lackWords(t, item.lacks)}</span>
    </span>
  );
}

export function FitSection({ item }: { item: LibraryFunction }) {
  const { t } = useTranslation();
  if (!item.lacks) return null;
  const fits = item.lacks.length === 0;
  return (
    <section aria-labelledby="fit">
      <h3 id="fit" className={styles.section}>
        {t("library.onYourDevices")}
      </h3>
      <Panel className={styles.fitPanel}>
        <span className={styles.fit} data-fits={fits}>
          {fits ? <Check size={16} aria-hidden="true" /> : <TriangleAlert size={16} aria-hidden="true" />}
          <span>{fits ? t("library.fitsAll") : t("library.fitsNot")}</span>
        </span>
        {fits ? null : (
          <ul className={styles.reasons}>
            {item.lacks.map((need) => (
              <li key={`${need.of}/${need.name}`}>{needWords(t, need)}</li>
            ))}
          </ul>
        )}
      </Panel>
    </section>
  );
}
