/** What a zone asks of robots, with a sentence about it: how fast they may be there, how many at once, or where to. */
import { NativeSelect, Radio } from "@mantine/core";
import { useTranslation } from "react-i18next";
import type { MapZone } from "@/api/types";
import { ZONE_RULES, type ZoneRule } from "@/api/zones";
import { NumberField } from "@/design/NumberField";
import { formatNumber } from "@/i18n/format";
import styles from "../places/places.module.css";
import { useSettled, type Keep } from "../useSettled";

export const USUAL_SPEED_M_S = 0.3;
const SLOWEST_M_S = 0.05;
const FASTEST_M_S = 5;
const MOST_ROBOTS = 20;
const NO_NUMBER = { speed_m_s: null, robots: null, heading_deg: null };
const HEADINGS = [0, 45, 90, 135, 180, 225, 270, 315] as const;

/** A rule with its number: the speed where robots drive slowly, how many may be in it, where they drive one way. */
export type RuleOfZone = Pick<MapZone, "rule" | "speed_m_s" | "robots" | "heading_deg">;

interface RuleFieldProps {
  value: RuleOfZone;
  change: Keep<RuleOfZone>;
}

export function RuleField({ value, change }: RuleFieldProps) {
  const { t } = useTranslation();
  const { rule, speed_m_s, robots, heading_deg } = value;
  const choose = (next: ZoneRule) =>
    change({
      rule: next,
      speed_m_s: next === "slow" ? (speed_m_s ?? USUAL_SPEED_M_S) : null,
      robots: next === "one_at_a_time" ? (robots ?? 1) : null,
      heading_deg: next === "one_way" ? (heading_deg ?? 0) : null,
    });
  return (
    <>
      <Radio.Group label={t("zone.rule")} value={rule} onChange={(next) => void choose(next)}>
        <div className={styles.adding}>
          {ZONE_RULES.map((each) => (
            <Radio key={each} value={each} label={t(`zone.rules.${each}`)} description={t(`zone.means.${each}`)} />
          ))}
        </div>
      </Radio.Group>
      {rule === "slow" ? (
        <SettledNumber
          label={t("zone.speed")}
          suffix=" m/s"
          step={0.1}
          min={SLOWEST_M_S}
          max={FASTEST_M_S}
          decimalScale={2}
          known={speed_m_s ?? USUAL_SPEED_M_S}
          keep={(next) => change({ ...NO_NUMBER, rule, speed_m_s: next })}
        />
      ) : null}
      {rule === "one_at_a_time" ? (
        <SettledNumber
          label={t("zone.robots")}
          step={1}
          min={1}
          max={MOST_ROBOTS}
          decimalScale={0}
          known={robots ?? 1}
          keep={(next) => change({ ...NO_NUMBER, rule, robots: next })}
        />
      ) : null}
      {rule === "one_way" ? (
        <HeadingField known={heading_deg ?? 0} keep={(next) => change({ ...NO_NUMBER, rule, heading_deg: next })} />
      ) : null}
    </>
  );
}

/** Where robots drive: one of eight directions, or another one that somebody has said elsewhere. */
function HeadingField({ known, keep }: { known: number; keep: Keep<number> }) {
  const { t } = useTranslation();
  const { value, settle } = useSettled(known, keep); // at once: who presses a key twice goes on from what is shown
  const others = HEADINGS.some((each) => each === value) ? [] : [value];
  const words = (each: number) =>
    HEADINGS.some((usual) => usual === each)
      ? t(`zone.headings.${each}`)
      : t("zone.headings.other", { degrees: formatNumber(each, 1) });
  return (
    <NativeSelect
      label={t("zone.heading")}
      value={String(value)}
      onChange={(event) => settle(Number(event.currentTarget.value))}
      data={[...HEADINGS, ...others].map((each) => ({ value: String(each), label: words(each) }))}
    />
  );
}

interface SettledNumberProps {
  label: string;
  suffix?: string;
  step: number;
  min: number;
  max: number;
  decimalScale: number;
  known: number;
  keep: Keep<number>;
}

/** A number that is kept when its field is left or Enter is pressed. */
function SettledNumber({ known, keep, ...field }: SettledNumberProps) {
  const { value, setValue, settle, takeBack } = useSettled<number | string>(known, (next) => keep(Number(next)));
  const leave = () => (typeof value === "number" ? settle(value) : takeBack());
  return (
    <NumberField
      {...field}
      value={value}
      onChange={setValue}
      onBlur={leave}
      onKeyDown={(event) => {
        if (event.key === "Enter") leave();
      }}
    />
  );
}
