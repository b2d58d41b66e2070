/** What the findings of a floor check say to a person, and how grave they are; pure. */
import type { TFunction } from "i18next";
import type { FloorFinding } from "@/api/types";
import { formatNumber, withUnit } from "@/i18n/format";

/** Findings that somebody may want so; all others keep robots from where they should come. */
const MAY_BE_SO: readonly FloorFinding["code"][] = ["keep_out", "together", "in_the_way"];

export const isError = ({ code }: Pick<FloorFinding, "code">) => !MAY_BE_SO.includes(code);

const BY_ZONE: readonly FloorFinding["code"][] = ["keep_out", "cut_off", "no_way_in", "no_way_out"];

/** What the site's zones do, so that it is mended where they are drawn. */
export const byZone = ({ code }: Pick<FloorFinding, "code">) => BY_ZONE.includes(code);

/** Tells a finding from all others of a check. */
export const keyOf = ({ code, target, other }: FloorFinding) => `${code} ${target} ${other ?? ""}`;

export const metres = (value: number) => withUnit(formatNumber(value, 2), "m");

/** Centimetres, rounded up: who makes room for so many has made enough. */
export const shortBy = (width_m: number, needs_m: number) =>
  withUnit(formatNumber(Math.max(1, Math.ceil((needs_m - width_m) * 100 - 1e-6))), "cm");

export interface FindingWords {
  readonly title: string;
  readonly text: string;
}

/** `nameOf` is what people call a place, a machine or a zone. */
export function findingWords(finding: FloorFinding, nameOf: (id: string) => string, t: TFunction): FindingWords {
  const { code, target, other, width_m, needs_m, beside } = finding;
  const said = {
    target: nameOf(target),
    other: other === null ? "" : nameOf(other),
    width: width_m === null ? "" : metres(width_m),
    needs: needs_m === null ? "" : metres(needs_m),
    short: width_m === null || needs_m === null ? "" : shortBy(width_m, needs_m),
    between: between(beside, nameOf, t),
  };
  const text = code === "cut_off" && other === null ? "cut_off_several" : code;
  return { title: t(`floorCheck.title.${code}`, said), text: t(`floorCheck.text.${text}`, said) };
}

function between(beside: FloorFinding["beside"], nameOf: (id: string) => string, t: TFunction): string {
  const names = beside.map((each) => (each === null ? t("floorCheck.wall") : nameOf(each)));
  const [one, other] = names;
  if (one === undefined) return t("floorCheck.there");
  if (other === undefined) return t("floorCheck.at", { one });
  return one === other && beside[0] === null ? t("floorCheck.betweenWalls") : t("floorCheck.between", { one, other });
}
