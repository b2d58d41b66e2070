/** The places over the map while an admin edits them, and the floor on which a new one is put. */
import type { SiteMap } from "@/api/types";
import { useRemovedMeanwhile } from "../useRemovedMeanwhile";
import { MovablePlace } from "./MovablePlace";
import { PlaceTool } from "./PlaceTool";
import type { PlaceEditing } from "./usePlaces";

export function PlaceHandles({ slug, map, places }: { slug: string; map: SiteMap; places: PlaceEditing }) {
  useRemovedMeanwhile(places.place, map.places, () => places.select(null));
  return (
    <>
      {map.places.map((place) => (
        <MovablePlace
          key={place.id}
          slug={slug}
          map={map}
          place={place}
          isSelected={places.place?.id === place.id}
          onSelect={() => places.select(place.id)}
        />
      ))}
      {places.adding ? <PlaceTool map={map} at={places.adding.at} put={places.put} stop={places.stop} /> : null}
    </>
  );
}
