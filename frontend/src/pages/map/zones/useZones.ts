/** What an admin does with the zones of a map at the moment: which one is selected, what is drawn of a new one. */
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { SiteMap } from "@/api/types";
import { useChangeZone, type ZoneFields } from "@/api/zones";
import { tellRefusal } from "@/shell/refusal";
import type { Outline } from "./outline";

export type ZoneEditing = ReturnType<typeof useZones>;

/** A new zone: its corners so far, and whether that is all of them. */
export interface Drawn {
  readonly corners: Outline;
  readonly closed: boolean;
}

export function useZones(slug: string, map: SiteMap) {
  const { t } = useTranslation();
  const change = useChangeZone(slug, (error) => tellRefusal(error, t));
  const [selected, select] = useState<string | null>(null);
  const [drawn, draw] = useState<Drawn | null>(null);
  const round = useRef(0); // what comes of one addition does nothing to the next
  const begin = () => {
    round.current += 1;
    select(null);
    draw({ corners: [], closed: false });
  };
  const add = (fields: ZoneFields) => {
    if (!drawn?.closed) return;
    const mine = round.current;
    const onSuccess = (zone: { id: string } | undefined) => {
      if (round.current !== mine) return;
      draw(null);
      select(zone?.id ?? null);
    };
    const zone = { ...fields, points: drawn.corners };
    change.mutate({ do: "add", zone }, { onSuccess });
  };
  const stop = () => {
    round.current += 1;
    draw(null);
  };
  return {
    zone: map.zones.find((each) => each.id === selected) ?? null,
    select,
    drawn,
    draw,
    begin,
    stop,
    add,
    isSending: change.isPending,
  };
}
