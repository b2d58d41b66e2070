/** The length beside the map, how one measures, and what is read out of it. */
import type { TFunction } from "i18next";
import { useTranslation } from "react-i18next";
import { formatPoint } from "@/i18n/format";
import { isSame } from "../../devices/placement";
import { metres } from "../check/findingWords";
import places from "../places/places.module.css";
import styles from "./measure.module.css";
import { lengthOf, lineOf, type Measuring } from "./measuring";

export function MeasurePanel({ measuring }: { measuring: Measuring }) {
  const { t } = useTranslation();
  const line = lineOf(measuring);
  return (
    <section aria-labelledby="measure" className={styles.panel}>
      <h2 id="measure">{t("measure.measure")}</h2>
      {line ? (
        <p className={styles.length}>{metres(lengthOf(line))}</p>
      ) : (
        <p className={styles.length} data-asks="">
          {t(measuring.ends.length === 0 ? "measure.first" : "measure.second")}
        </p>
      )}
      <p id="measure-help" className={places.quiet}>
        {t("measure.help")}
      </p>
      <p role="status" className="visually-hidden">
        {saidOf(measuring, t)}
      </p>
    </section>
  );
}

/** What is read out: each end, the length, and where keys aim; not what a pointer passes. */
export function saidOf(measuring: Measuring, t: TFunction): string {
  const { ends, aim, cross } = measuring;
  const line = lineOf(measuring);
  const length = line ? lengthOf(line) : 0;
  const [first, second] = ends;
  const keyed = cross && aim ? formatPoint(...aim) : "";
  if (second && keyed && !isSame(aim ?? second, second)) return t("measure.cross", { at: keyed });
  if (second) return t("measure.measured", { length: metres(length) });
  if (!first) return keyed && t("measure.cross", { at: keyed });
  if (keyed && length > 0) return t("measure.soFar", { length: metres(length), at: keyed });
  return t("measure.begun", { at: formatPoint(...first) });
}
