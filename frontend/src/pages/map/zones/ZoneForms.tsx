/** What a zone is called and asks: the one that is selected, and the one that is about to be. */
import { Button, TextInput } from "@mantine/core";
import { Trash2 } from "lucide-react";
import { useEffect, useRef, useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import type { MapZone, SiteMap } from "@/api/types";
import { useChangeZone, type ZoneFields } from "@/api/zones";
import { formatNumber, withUnit } from "@/i18n/format";
import { tellRefusal } from "@/shell/refusal";
import { KeptName } from "../KeptName";
import styles from "../places/places.module.css";
import { areaOf } from "./outline";
import { RuleField, type RuleOfZone } from "./RuleField";
import { ZoneUses } from "./RemoveZone";
import type { ZoneEditing } from "./useZones";

/** A rule as it is sent: with the number that belongs to it, and without the others. */
function said({ rule, speed_m_s, robots, heading_deg }: RuleOfZone): ZoneFields {
  return {
    rule,
    ...(speed_m_s === null ? {} : { speed_m_s }),
    ...(robots === null ? {} : { robots }),
    ...(heading_deg === null ? {} : { heading_deg }),
  };
}

interface ZoneFormProps {
  slug: string;
  map: SiteMap;
  zone: MapZone;
  remove: () => void;
}

export function ZoneForm({ slug, map, zone, remove }: ZoneFormProps) {
  const { t } = useTranslation();
  const change = useChangeZone(slug, (error) => tellRefusal(error, t));
  /** Whether it was taken: each change is answered for itself, also where another one has followed. */
  const edit = (fields: ZoneFields) =>
    change.mutateAsync({ do: "edit", id: zone.id, fields }).then(
      () => true,
      () => false,
    );
  return (
    <div className={styles.form} role="group" aria-label={t("zone.about", { name: zone.name })}>
      <KeptName label={t("zone.name")} name={zone.name} keep={(name) => edit({ name })} />
      <RuleField value={zone} change={(rule) => edit(said(rule))} />
      <p className={styles.quiet}>{t("zone.area", { area: withUnit(formatNumber(areaOf(zone.points), 1), "m²") })}</p>
      <ZoneUses slug={slug} map={map} zone={zone} />
      <Button variant="default" color="red" leftSection={<Trash2 size={15} aria-hidden="true" />} onClick={remove}>
        {t("zone.remove")}
      </Button>
    </div>
  );
}

export function NewZoneForm({ editing }: { editing: ZoneEditing }) {
  const { t } = useTranslation();
  const [name, setName] = useState("");
  const [rule, setRule] = useState<RuleOfZone>({
    rule: "keep_out",
    speed_m_s: null,
    robots: null,
    heading_deg: null,
  });
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => field.current?.focus(), []);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (name.trim()) editing.add({ name: name.trim(), ...said(rule) });
  };
  return (
    <form onSubmit={submit} className={styles.form} aria-label={t("zone.new")}>
      <TextInput
        ref={field}
        label={t("zone.name")}
        placeholder={t("zone.example")}
        maxLength={60}
        value={name}
        onChange={(event) => setName(event.currentTarget.value)}
        onKeyDown={(event) => {
          if (event.key === "Escape") editing.stop();
        }}
      />
      <RuleField value={rule} change={(next) => (setRule(next), true)} />
      <p className={styles.quiet}>
        {t("zone.area", { area: withUnit(formatNumber(areaOf(editing.drawn?.corners ?? []), 1), "m²") })}
      </p>
      <Button type="submit" disabled={!name.trim()} loading={editing.isSending}>
        {t("zone.create")}
      </Button>
    </form>
  );
}
