/** What a place is, with a sentence about it. */
import { SegmentedControl } from "@mantine/core";
import { useId } from "react";
import { useTranslation } from "react-i18next";
import { PLACE_KINDS, type PlaceKind } from "@/api/places";
import styles from "./places.module.css";

export function KindField({ kind, change }: { kind: string; change: (kind: PlaceKind) => void }) {
  const { t } = useTranslation();
  const label = useId();
  return (
    <div>
      <p className={styles.label} id={label}>
        {t("place.kind")}
      </p>
      <SegmentedControl
        fullWidth
        aria-labelledby={label}
        value={kind}
        onChange={(next) => change(next as PlaceKind)}
        data={PLACE_KINDS.map((each) => ({ value: each, label: t(`pages.map.kind.${each}`) }))}
      />
      <p className={styles.means}>{t(`place.means.${kind}`)}</p>
    </div>
  );
}
