/** The selected place: its name, what it is, how a robot parks there, who goes there. */
import { Button, TextInput } from "@mantine/core";
import { Trash2 } from "lucide-react";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { useChangePlace, type PlaceFields } from "@/api/places";
import type { MapPlace } from "@/api/types";
import { NumberField } from "@/design/NumberField";
import { formatPoint } from "@/i18n/format";
import { KindField } from "./KindField";
import { PlaceUses } from "./RemovePlace";
import { tellRefusal } from "@/shell/refusal";
import styles from "./places.module.css";

interface PlaceFormProps {
  slug: string;
  place: MapPlace;
  remove: () => void;
}

export function PlaceForm({ slug, place, remove }: PlaceFormProps) {
  const { t } = useTranslation();
  const change = useChangePlace(slug);
  const edit = (fields: PlaceFields, refused?: () => void) =>
    change.mutate({ do: "edit", id: place.id, fields }, { onError: (error) => (refused?.(), tellRefusal(error, t)) });
  return (
    <div className={styles.form} role="group" aria-label={t("place.about", { name: place.name })}>
      <NameField place={place} keep={(name, refused) => edit({ name }, refused)} />
      <KindField kind={place.kind} change={(kind) => edit({ kind })} />
      {place.kind === "dock" ? <HeadingField place={place} keep={(theta) => edit({ theta })} /> : null}
      <p className={styles.quiet}>
        {t("place.id")} <code>{place.id}</code>, {formatPoint(place.x, place.y)}
      </p>
      <PlaceUses slug={slug} place={place.id} />
      <Button variant="default" color="red" leftSection={<Trash2 size={15} aria-hidden="true" />} onClick={remove}>
        {t("place.remove")}
      </Button>
    </div>
  );
}

/** Kept when the field is left or Enter is pressed; Esc takes back what was typed. */
function NameField({ place, keep }: { place: MapPlace; keep: (name: string, refused: () => void) => void }) {
  const { t } = useTranslation();
  const [name, setName] = useState(place.name);
  useEffect(() => setName(place.name), [place.name]);
  const settle = () => {
    const next = name.trim();
    if (next && next !== place.name) keep(next, () => setName(place.name));
    else setName(place.name);
  };
  return (
    <TextInput
      label={t("place.name")}
      maxLength={60}
      value={name}
      onChange={(event) => setName(event.currentTarget.value)}
      onBlur={settle}
      onKeyDown={(event) => {
        if (event.key === "Enter") settle();
        if (event.key === "Escape") setName(place.name);
      }}
    />
  );
}

function HeadingField({ place, keep }: { place: MapPlace; keep: (theta: number) => void }) {
  const { t } = useTranslation();
  const known = Math.round((place.theta * 180) / Math.PI);
  const [degrees, setDegrees] = useState<number | string>(known);
  useEffect(() => setDegrees(known), [known]);
  const settle = () => {
    if (typeof degrees === "number" && degrees !== known) keep((degrees * Math.PI) / 180);
    else setDegrees(known);
  };
  return (
    <NumberField
      label={t("place.heading")}
      description={t("place.headingHelp")}
      suffix="°"
      step={15}
      min={-360}
      max={360}
      value={degrees}
      onChange={setDegrees}
      onBlur={settle}
      onKeyDown={(event) => {
        if (event.key === "Enter") settle();
      }}
    />
  );
}
