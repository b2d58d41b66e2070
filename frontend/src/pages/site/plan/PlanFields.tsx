/** What is said about a picture of a plan: how long the measured line is, what is dark enough to be wall. */
import { Slider, Switch } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { NumberField } from "@/design/NumberField";
import { formatNumber, withUnit } from "@/i18n/format";
import { isTooLarge, planSize, type Picture, type PlanReading } from "./picture";
import styles from "./plan.module.css";

/** A picture as it is first looked at: a line across its middle, of no length yet. */
export function firstReading({ width, height }: Picture): PlanReading {
  const y = Math.round(height / 2);
  return {
    threshold: 128,
    length: 0,
    outsideUnknown: false,
    line: [
      [Math.round(width * 0.15), y],
      [Math.round(width * 0.85), y],
    ],
  };
}

interface FieldsProps {
  picture: Picture;
  reading: PlanReading;
  change: (reading: PlanReading) => void;
}

export function PlanFields({ picture, reading, change }: FieldsProps) {
  const { t } = useTranslation();
  const size = planSize(picture, reading);
  const metres = (value: number) => withUnit(formatNumber(value, 1), "m");
  return (
    <div className={styles.fields}>
      <p>{t("mapEdit.plan.help")}</p>
      <NumberField
        label={t("mapEdit.plan.length")}
        description={size ? t("mapEdit.plan.size", { width: metres(size.width), height: metres(size.height) }) : null}
        error={size && isTooLarge(size) ? t("mapImport.tooLarge") : null}
        suffix=" m"
        min={0}
        decimalScale={3}
        value={reading.length || ""}
        onChange={(length) => change({ ...reading, length: Number(length) || 0 })}
      />
      <div>
        <label id="plan-threshold" className={styles.label}>
          {t("mapEdit.plan.threshold")}
        </label>
        <Slider
          min={1}
          max={255}
          label={null}
          value={reading.threshold}
          thumbProps={{ "aria-labelledby": "plan-threshold" }}
          onChange={(threshold) => change({ ...reading, threshold })}
        />
      </div>
      <Switch
        label={t("mapEdit.plan.outside")}
        checked={reading.outsideUnknown}
        onChange={(event) => change({ ...reading, outsideUnknown: event.currentTarget.checked })}
      />
    </div>
  );
}
