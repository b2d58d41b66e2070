/** Units as descriptions name them (QUDT codes) and as people read them. */
import { ownEntry } from "@/design/ownEntry";

const SIGNS: Readonly<Record<string, string>> = {
  PERCENT: "%",
  DEG_C: "°C",
  DEG: "°",
  RAD: "rad",
  MIN: "min",
  SEC: "s",
  HR: "h",
  M: "m",
  "M-PER-SEC": "m/s",
  KiloGM: "kg",
  BAR: "bar",
  PA: "Pa",
  V: "V",
  A: "A",
  W: "W",
  "REV-PER-MIN": "rpm",
  UNITLESS: "",
  NUM: "",
};

/** `°C` for `DEG_C`; what is not known stays as it is. */
export function unitSign(unit: string): string {
  return ownEntry(SIGNS, unit) ?? unit;
}
