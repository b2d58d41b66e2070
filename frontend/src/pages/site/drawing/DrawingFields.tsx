/** What is said about a DXF drawing: its unit, which layers are walls, how thick these are, how large a cell is. */
import { Checkbox, NativeSelect, Switch } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { NumberField } from "@/design/NumberField";
import { formatNumber, withUnit } from "@/i18n/format";
import { isTooFine, sizeOf, skippedOf, UNITS, type Drawing, type DrawingReading } from "./drawing";
import { isTooLarge } from "../plan/picture";
import styles from "./drawing.module.css";

interface FieldsProps {
  drawing: Drawing;
  reading: DrawingReading;
  change: (reading: DrawingReading) => void;
}

export function DrawingFields({ drawing, reading, change }: FieldsProps) {
  const { t } = useTranslation();
  const size = sizeOf(drawing, reading);
  const metres = (value: number) => withUnit(formatNumber(value, 1), "m");
  const { blocks, far, others } = skippedOf(drawing);
  return (
    <div className={styles.fields}>
      <NativeSelect
        label={t("mapImport.drawing.unit")}
        description={t(drawing.metres === null ? "mapImport.drawing.unitAsked" : "mapImport.drawing.unitSaid")}
        error={size && isTooLarge(size) ? t("mapImport.tooLarge") : null}
        value={String(reading.metres)}
        onChange={(event) => change({ ...reading, metres: Number(event.currentTarget.value) })}
        data={[
          ...(reading.metres ? [] : [{ value: "0", label: t("mapImport.drawing.chooseUnit") }]),
          ...Object.entries(UNITS).map(([name, value]) => ({
            value: String(value),
            label: t(`mapImport.drawing.units.${name}`),
          })),
        ]}
      />
      {size ? <p>{t("mapImport.drawing.size", { width: metres(size.width), height: metres(size.height) })}</p> : null}
      <Layers drawing={drawing} reading={reading} change={change} />
      <div className={styles.pair}>
        <NumberField
          label={t("mapImport.drawing.thickness")}
          suffix=" m"
          min={0}
          max={2}
          step={0.05}
          decimalScale={3}
          value={reading.thickness}
          onChange={(value) => change({ ...reading, thickness: Math.min(2, Math.max(0, Number(value) || 0)) })}
        />
        <NumberField
          label={t("mapImport.drawing.cell")}
          suffix=" m"
          min={0.01}
          max={1}
          step={0.01}
          decimalScale={3}
          value={reading.cell}
          error={isTooFine(drawing, reading) ? t("mapImport.drawing.tooFine") : null}
          onChange={(value) => change({ ...reading, cell: Math.min(1, Math.max(0.01, Number(value) || 0.05)) })}
        />
      </div>
      <Switch
        label={t("mapEdit.plan.outside")}
        checked={reading.outsideUnknown}
        onChange={(event) => change({ ...reading, outsideUnknown: event.currentTarget.checked })}
      />
      {blocks ? <p>{t("mapImport.drawing.lost", { count: blocks })}</p> : null}
      {far ? <p>{t("mapImport.drawing.far", { count: far })}</p> : null}
      {others ? <p>{t("mapImport.drawing.skipped", { count: others })}</p> : null}
    </div>
  );
}

function Layers({ drawing, reading, change }: FieldsProps) {
  const { t } = useTranslation();
  return (
    <Checkbox.Group
      label={t("mapImport.drawing.layers")}
      value={[...reading.layers]}
      error={reading.layers.length === 0 ? t("mapImport.drawing.noLayer") : null}
      onChange={(layers) => change({ ...reading, layers })}
    >
      <div className={styles.layers}>
        {drawing.layers.map(({ name, hidden, lines }) => (
          <Checkbox
            key={name}
            value={name}
            label={t(hidden ? "mapImport.drawing.hiddenLayer" : "mapImport.drawing.layer", {
              name,
              count: lines.length,
            })}
          />
        ))}
      </div>
    </Checkbox.Group>
  );
}
