/** A short word beside a device that is simulated in place of the real one. */
import { Boxes } from "lucide-react";
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import styles from "./standin.module.css";

export function StandInMark({ title, children }: { title?: string; children?: ReactNode }) {
  const { t } = useTranslation();
  return (
    <span className={styles.mark} title={title ?? t("device.standIn.told")}>
      <Boxes size={13} aria-hidden="true" />
      {t("device.standIn.mark")}
      {children ? <>: {children}</> : null}
    </span>
  );
}
