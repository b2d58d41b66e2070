/** What the tool in hand is told, and what is done to the map as a whole. */
import { Button, SegmentedControl } from "@mantine/core";
import { RotateCcw, RotateCw, Sparkles } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { NumberField } from "@/design/NumberField";
import { formatNumber, withUnit } from "@/i18n/format";
import type { CellMap } from "@/map/floor/rosFiles";
import type { Point } from "@/map/plane/projection";
import { rescale, type Material } from "./cells/edits";
import { eraseSpecks } from "./cells/specks";
import { fitsTurned, turnBy, turnQuarter } from "./cells/turning";
import { lengthOf } from "../map/measure/measuring";
import styles from "./mapEdit.module.css";
import type { Settings } from "./tools";

interface PanelProps {
  map: CellMap;
  settings: Settings;
  set: (settings: Settings) => void;
  /** Go on with a map that lies as this one does, or with one that does not. */
  change: (map: CellMap) => void;
  changeLie: (map: CellMap) => void;
  measured: readonly Point[];
}

const MATERIALS: readonly Material[] = ["wall", "floor", "unknown"];

export function ToolPanel({ map, settings, set, change, changeLie, measured }: PanelProps) {
  const { t } = useTranslation();
  const { tool } = settings;
  return (
    <>
      <section aria-labelledby="tool-name">
        <h2 id="tool-name">{t(`mapEdit.tool.${tool}`)}</h2>
        <p className={styles.quiet}>{t(`mapEdit.toolHelp.${tool}`)}</p>
        {tool === "brush" || tool === "line" || tool === "box" ? (
          <SegmentedControl
            fullWidth
            aria-label={t("mapEdit.leaves")}
            data={MATERIALS.map((value) => ({ value, label: t(`mapEdit.material.${value}`) }))}
            value={settings.material[tool]}
            onChange={(value) => set({ ...settings, material: { ...settings.material, [tool]: value } })}
          />
        ) : null}
        {tool === "brush" || tool === "line" ? (
          <NumberField
            label={t("mapEdit.width")}
            suffix=" cm"
            min={1}
            max={1000}
            step={5}
            value={Math.round(settings.width[tool] * 100)}
            onChange={(value) =>
              Number(value) > 0 && set({ ...settings, width: { ...settings.width, [tool]: Number(value) / 100 } })
            }
          />
        ) : null}
        {tool === "measure" ? <Scale map={map} measured={measured} changeLie={changeLie} /> : null}
      </section>
      <Turning map={map} changeLie={changeLie} />
      <Specks map={map} change={change} />
    </>
  );
}

function Scale({ map, measured, changeLie }: Pick<PanelProps, "map" | "changeLie" | "measured">) {
  const { t } = useTranslation();
  const [length, setLength] = useState<number | string>("");
  const known = lengthOf(measured);
  const scaled = known > 0 && Number(length) > 0 ? rescale(map, Number(length) / known) : map;
  return (
    <>
      <NumberField
        label={t("mapEdit.trueLength")}
        description={known > 0 ? t("mapEdit.measured", { length: withUnit(formatNumber(known, 2), "m") }) : null}
        suffix=" m"
        min={0}
        decimalScale={3}
        disabled={known === 0}
        value={length}
        onChange={setLength}
      />
      <Button variant="default" disabled={scaled === map} onClick={() => changeLie(scaled)}>
        {t("mapEdit.scale")}
      </Button>
    </>
  );
}

function Turning({ map, changeLie }: Pick<PanelProps, "map" | "changeLie">) {
  const { t } = useTranslation();
  const [degrees, setDegrees] = useState<number | string>("");
  const isTooLarge = !fitsTurned(map, Number(degrees));
  const turned = Number(degrees) && !isTooLarge ? () => changeLie(turnBy(map, Number(degrees))) : undefined;
  return (
    <section aria-labelledby="turn">
      <h2 id="turn">{t("mapEdit.turn")}</h2>
      <div className={styles.pair}>
        {(["left", "right"] as const).map((way) => (
          <Button
            key={way}
            variant="default"
            leftSection={way === "left" ? <RotateCcw size={16} /> : <RotateCw size={16} />}
            onClick={() => changeLie(turnQuarter(map, way))}
          >
            {t(`mapEdit.quarter.${way}`)}
          </Button>
        ))}
      </div>
      <div className={styles.pair}>
        <NumberField
          aria-label={t("mapEdit.angle")}
          placeholder={t("mapEdit.angle")}
          suffix="°"
          min={-180}
          max={180}
          step={0.5}
          decimalScale={2}
          value={degrees}
          onChange={setDegrees}
        />
        <Button variant="default" disabled={!turned} onClick={turned}>
          {t("mapEdit.turnBy")}
        </Button>
      </div>
      <p className={styles.quiet} role="status">
        {isTooLarge ? t("mapEdit.turnedTooLarge") : ""}
      </p>
    </section>
  );
}

function Specks({ map, change }: Pick<PanelProps, "map" | "change">) {
  const { t } = useTranslation();
  const [least, setLeast] = useState<number | string>(6);
  const [told, setTold] = useState("");
  const erase = () => {
    const { map: clean, specks } = eraseSpecks(map, Number(least));
    setTold(t("mapEdit.specksGone", { count: specks }));
    change(clean);
  };
  return (
    <section aria-labelledby="specks">
      <h2 id="specks">{t("mapEdit.specks")}</h2>
      <NumberField label={t("mapEdit.least")} min={2} max={10_000} value={least} onChange={setLeast} />
      <Button variant="default" leftSection={<Sparkles size={16} />} disabled={!(Number(least) >= 2)} onClick={erase}>
        {t("mapEdit.eraseSpecks")}
      </Button>
      <p className={styles.quiet} role="status">
        {told}
      </p>
    </section>
  );
}
