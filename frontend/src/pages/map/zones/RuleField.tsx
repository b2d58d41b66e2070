/** What a zone asks of robots, with a sentence about it; where they drive slowly, how fast they may be. */
import { NumberInput, Radio } from "@mantine/core";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { ZONE_RULES, type ZoneRule } from "@/api/zones";
import styles from "../places/places.module.css";

export const USUAL_SPEED_M_S = 0.3;
const SLOWEST_M_S = 0.05;
const FASTEST_M_S = 5;

interface RuleFieldProps {
  rule: ZoneRule;
  speed: number | null;
  change: (rule: ZoneRule, speed: number | null) => void;
}

export function RuleField({ rule, speed, change }: RuleFieldProps) {
  const { t } = useTranslation();
  const choose = (next: ZoneRule) => change(next, next === "slow" ? (speed ?? USUAL_SPEED_M_S) : null);
  return (
    <>
      <Radio.Group label={t("zone.rule")} value={rule} onChange={(next) => choose(next)}>
        <div className={styles.adding}>
          {ZONE_RULES.map((each) => (
            <Radio key={each} value={each} label={t(`zone.rules.${each}`)} description={t(`zone.means.${each}`)} />
          ))}
        </div>
      </Radio.Group>
      {rule === "slow" ? <SpeedField speed={speed} keep={(next) => change("slow", next)} /> : null}
    </>
  );
}

/** Kept when the field is left or Enter is pressed. */
function SpeedField({ speed, keep }: { speed: number | null; keep: (speed: number) => void }) {
  const { t } = useTranslation();
  const known = speed ?? USUAL_SPEED_M_S;
  const [value, setValue] = useState<number | string>(known);
  useEffect(() => setValue(known), [known]);
  const settle = () => {
    if (typeof value === "number" && value !== known) keep(value);
    else setValue(known);
  };
  return (
    <NumberInput
      label={t("zone.speed")}
      suffix=" m/s"
      step={0.1}
      min={SLOWEST_M_S}
      max={FASTEST_M_S}
      decimalScale={2}
      value={value}
      onChange={setValue}
      onBlur={settle}
      onKeyDown={(event) => {
        if (event.key === "Enter") settle();
      }}
    />
  );
}
