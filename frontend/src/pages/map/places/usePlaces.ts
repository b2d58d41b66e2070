/** What an admin does with the places of a map at the moment: which one is selected, where a new one is to be. */
import { useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { useChangePlace, type PlaceKind } from "@/api/places";
import type { SiteMap } from "@/api/types";
import type { Point } from "@/map/plane/projection";
import { tellRefusal } from "@/shell/refusal";

export type PlaceEditing = ReturnType<typeof usePlaces>;

/** `adding` is null while no place is being added; its `at` is null until somebody says where. */
export function usePlaces(slug: string, map: SiteMap) {
  const { t } = useTranslation();
  const change = useChangePlace(slug, (error) => tellRefusal(error, t));
  const [selected, select] = useState<string | null>(null);
  const [adding, setAdding] = useState<{ at: Point | null } | null>(null);
  const round = useRef(0); // what comes of one addition does nothing to the next
  const begin = () => {
    round.current += 1;
    select(null);
    setAdding({ at: null });
  };
  const add = (name: string, kind: PlaceKind) => {
    if (!adding?.at) return;
    const [x, y] = adding.at;
    const mine = round.current;
    const onSuccess = (place: { id: string } | undefined) => {
      if (round.current !== mine) return;
      setAdding(null);
      select(place?.id ?? null);
    };
    change.mutate({ do: "add", place: { name, kind, x, y } }, { onSuccess });
  };
  const stop = () => {
    round.current += 1;
    setAdding(null);
  };
  return {
    place: map.places.find((each) => each.id === selected) ?? null,
    select,
    adding,
    begin,
    put: (at: Point) => setAdding({ at }),
    stop,
    add,
    isSending: change.isPending,
  };
}
