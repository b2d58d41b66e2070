/** The places of a map as a list; admins add, change and remove them here. */
import { Button } from "@mantine/core";
import { MapPinPlus, X } from "lucide-react";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import type { MapPlace, SiteMap } from "@/api/types";
import { Chip } from "@/design/Chip";
import { formatPoint } from "@/i18n/format";
import { NewPlaceForm } from "./NewPlaceForm";
import { PlaceForm } from "./PlaceForm";
import { RemovePlace } from "./RemovePlace";
import type { PlaceEditing } from "./usePlaces";
import styles from "./places.module.css";

interface PlacesPanelProps {
  slug: string;
  map: SiteMap;
  /** Null for who only looks. */
  editing: PlaceEditing | null;
}

export function PlacesPanel({ slug, map, editing }: PlacesPanelProps) {
  const { t } = useTranslation();
  const [removing, setRemoving] = useState<MapPlace | null>(null);
  const isThere = map.places.some(({ id }) => id === removing?.id);
  useEffect(() => {
    if (!isThere) setRemoving(null); // whoever has removed it
  }, [isThere]);
  return (
    <section aria-labelledby="places">
      <h2 id="places">{t("pages.map.places")}</h2>
      {editing ? <Adding editing={editing} /> : null}
      {map.places.length === 0 ? <p className={styles.quiet}>{t("pages.map.noPlaces")}</p> : null}
      <ul className={styles.list}>
        {map.places.map((place) => (
          <li key={place.id}>
            <Row place={place} editing={editing} />
            {editing?.place?.id === place.id ? (
              <PlaceForm slug={slug} place={place} remove={() => setRemoving(place)} />
            ) : null}
          </li>
        ))}
      </ul>
      {editing && removing && isThere ? (
        <RemovePlace slug={slug} place={removing} select={editing.select} onClose={() => setRemoving(null)} />
      ) : null}
    </section>
  );
}

function Adding({ editing }: { editing: PlaceEditing }) {
  const { t } = useTranslation();
  const { adding, begin, stop } = editing;
  const Icon = adding ? X : MapPinPlus;
  return (
    <div className={styles.adding}>
      <p id="places-help" className={styles.quiet}>
        {t(adding ? "place.putHelp" : "place.help")}
      </p>
      {adding?.at ? <NewPlaceForm editing={editing} /> : null}
      <Button
        variant={adding ? "default" : "light"}
        leftSection={<Icon size={16} aria-hidden="true" />}
        onClick={adding ? stop : begin}
      >
        {t(adding ? "place.addStop" : "place.add")}
      </Button>
    </div>
  );
}

function Row({ place, editing }: { place: MapPlace; editing: PlaceEditing | null }) {
  const { t } = useTranslation();
  const kind = t(`pages.map.kind.${place.kind}`, { defaultValue: place.kind });
  const words = (
    <>
      <span>{place.name}</span>
      <Chip>{kind}</Chip>
      <code>{formatPoint(place.x, place.y)}</code>
    </>
  );
  if (!editing) return <div className={styles.row}>{words}</div>;
  const isOpen = editing.place?.id === place.id;
  return (
    <button
      type="button"
      className={styles.row}
      aria-expanded={isOpen}
      onClick={() => editing.select(isOpen ? null : place.id)}
    >
      {words}
    </button>
  );
}
