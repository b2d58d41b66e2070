/** Units as descriptions name them (QUDT codes) and as people read them. */
import { ownEntry } from "@/design/ownEntry";
import TABLE from "./units.json";

/** Codes and symbols, as `make constructs` writes them from `vipo_device/protocol/units.py`. */
const SIGNS: Readonly<Record<string, string>> = { ...TABLE, UNITLESS: "", NUM: "" };
const COMMON = ["SEC", "MIN", "HR", "DEG_C", "PERCENT", "M", "CentiM", "MilliM", "KiloGM", "GM", "L", "M-PER-SEC"];

/** The units that people choose from, the common ones first. */
export const UNIT_CHOICES: readonly { readonly value: string; readonly label: string }[] = [
  ...COMMON,
  ...Object.keys(TABLE).filter((code) => !COMMON.includes(code)),
].map((value) => ({ value, label: unitSign(value) }));

const SHARES: ReadonlySet<string> = new Set(["", "PERCENT", "NUM", "UNITLESS"]);

/** Whether a number in this unit is per cent, as one without a unit is; volts say nothing of how full a battery is. */
export const isShare = (unit: string): boolean => SHARES.has(unit);

/** `°C` for `DEG_C`; what is not known stays as it is, and what is no text (a document may hold anything) is none. */
export function unitSign(unit: string | null | undefined): string {
  if (!unit || typeof unit !== "string") return "";
  return ownEntry(SIGNS, unit) ?? unit;
}
