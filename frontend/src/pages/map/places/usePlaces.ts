/** What an admin does with the places of a map at the moment: which one is selected, whether one is being added. */
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { useChangePlace } from "@/api/places";
import type { SiteMap } from "@/api/types";
import type { Point } from "@/map/plane/projection";
import { freeName } from "./newPlace";
import { tellRefusal } from "./refusal";

export type PlaceEditing = ReturnType<typeof usePlaces>;

export function usePlaces(slug: string, map: SiteMap) {
  const { t } = useTranslation();
  const change = useChangePlace(slug);
  const [selected, setSelected] = useState<string | null>(null);
  const [made, setMade] = useState<string | null>(null);
  const [isAdding, setAdding] = useState(false);
  const put = ([x, y]: Point) => {
    setAdding(false);
    const name = freeName(map.places, (number) => t("place.new", { number }));
    change.mutate(
      { do: "add", place: { name, kind: "point", x, y } },
      {
        onSuccess: (place) => {
          setSelected(place?.id ?? null);
          setMade(place?.id ?? null);
        },
        onError: (error) => tellRefusal(error, t),
      },
    );
  };
  const select = (id: string | null) => {
    setSelected(id);
    if (id !== made) setMade(null);
  };
  return { place: map.places.find((each) => each.id === selected) ?? null, made, isAdding, setAdding, put, select };
}
