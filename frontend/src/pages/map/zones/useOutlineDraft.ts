/** The outline of a zone for the one who changes it, until the server says the same. */
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import type { MapZone } from "@/api/types";
import { useChangeZone } from "@/api/zones";
import { tellRefusal } from "@/shell/refusal";
import { isSameOutline, type Outline } from "./outline";

export interface OutlineDraft {
  readonly points: Outline;
  /** Show this outline; null: the one that is kept. */
  readonly show: (points: Outline | null) => void;
  /** Send what is shown, or this. */
  readonly keep: (points?: Outline) => void;
}

export function useOutlineDraft(slug: string, zone: MapZone): OutlineDraft {
  const { t } = useTranslation();
  const change = useChangeZone(slug);
  const [draft, show] = useState<Outline | null>(null);
  const kept = JSON.stringify(zone.points);
  useEffect(() => show(null), [kept]);
  const keep = (given?: Outline) => {
    const points = given ?? draft;
    if (!points) return;
    if (isSameOutline(points, zone.points)) {
      show(null);
      return;
    }
    show(points);
    const onError = (error: Error) => {
      show(null);
      tellRefusal(error, t);
    };
    change.mutate({ do: "edit", id: zone.id, fields: { points } }, { onError });
  };
  return { points: draft ?? zone.points, show, keep };
}
