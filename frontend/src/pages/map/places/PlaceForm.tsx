/** The selected place: its name, what it is, how a robot parks there, who goes there. */
import { Button } from "@mantine/core";
import { Trash2 } from "lucide-react";
import { useTranslation } from "react-i18next";
import { useChangePlace, type PlaceFields } from "@/api/places";
import type { MapPlace } from "@/api/types";
import { NumberField } from "@/design/NumberField";
import { formatPoint } from "@/i18n/format";
import { tellRefusal } from "@/shell/refusal";
import { KeptName } from "../KeptName";
import { useSettled, type Keep } from "../useSettled";
import { KindField } from "./KindField";
import { PlaceUses } from "./RemovePlace";
import styles from "./places.module.css";

interface PlaceFormProps {
  slug: string;
  place: MapPlace;
  remove: () => void;
}

export function PlaceForm({ slug, place, remove }: PlaceFormProps) {
  const { t } = useTranslation();
  const change = useChangePlace(slug, (error) => tellRefusal(error, t));
  /** Whether it was taken: each change is answered for itself, also where another one has followed. */
  const edit = (fields: PlaceFields) =>
    change.mutateAsync({ do: "edit", id: place.id, fields }).then(
      () => true,
      () => false,
    );
  return (
    <div className={styles.form} role="group" aria-label={t("place.about", { name: place.name })}>
      <KeptName label={t("place.name")} name={place.name} keep={(name) => edit({ name })} />
      <KindField kind={place.kind} change={(kind) => void edit({ kind })} />
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

function HeadingField({ place, keep }: { place: MapPlace; keep: Keep<number> }) {
  const { t } = useTranslation();
  const known = Math.round((place.theta * 180) / Math.PI);
  const { value, setValue, settle, takeBack } = useSettled<number | string>(known, (degrees) =>
    keep((Number(degrees) * Math.PI) / 180),
  );
  const leave = () => (typeof value === "number" ? settle(value) : takeBack());
  return (
    <NumberField
      label={t("place.heading")}
      description={t("place.headingHelp")}
      suffix="°"
      step={15}
      min={-360}
      max={360}
      value={value}
      onChange={setValue}
      onBlur={leave}
      onKeyDown={(event) => {
        if (event.key === "Enter") leave();
      }}
    />
  );
}
