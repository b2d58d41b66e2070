/** The outline of a zone for the one who changes it, until the server says the same. */
import { useTranslation } from "react-i18next";
import type { MapZone } from "@/api/types";
import { useChangeZone } from "@/api/zones";
import { tellRefusal } from "@/shell/refusal";
import { useDraft } from "../../devices/movable";
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
  const change = useChangeZone(slug, (error) => tellRefusal(error, t));
  const draft = useDraft<Outline>(zone.points, isSameOutline, change.isPending, (points, done) =>
    change.mutate({ do: "edit", id: zone.id, fields: { points } }, done),
  );
  return { points: draft.at, show: draft.setDraft, keep: draft.keep };
}
