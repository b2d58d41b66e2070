/** A place that is about to be: what it is called and what it is. Where it is, the map says. */
import { Button, TextInput } from "@mantine/core";
import { useEffect, useRef, useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import type { PlaceKind } from "@/api/places";
import { formatPoint } from "@/i18n/format";
import { KindField } from "./KindField";
import type { PlaceEditing } from "./usePlaces";
import styles from "./places.module.css";

export function NewPlaceForm({ editing }: { editing: PlaceEditing }) {
  const { t } = useTranslation();
  const [name, setName] = useState("");
  const [kind, setKind] = useState<PlaceKind>("point");
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => field.current?.focus(), []);
  const at = editing.adding?.at;
  if (!at) return null;
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (name.trim()) editing.add(name.trim(), kind);
  };
  return (
    <form onSubmit={submit} className={styles.form} aria-label={t("place.new")}>
      <TextInput
        ref={field}
        label={t("place.name")}
        placeholder={t("place.example")}
        maxLength={60}
        value={name}
        onChange={(event) => setName(event.currentTarget.value)}
        onKeyDown={(event) => {
          if (event.key === "Escape") editing.stop();
        }}
      />
      <KindField kind={kind} change={setKind} />
      <p className={styles.quiet}>{t("place.where", { at: formatPoint(at[0], at[1]) })}</p>
      <Button type="submit" disabled={!name.trim()} loading={editing.isSending}>
        {t("place.create")}
      </Button>
    </form>
  );
}
