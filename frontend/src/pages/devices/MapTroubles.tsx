/** Machines and places that another map would not suit. */
import { CircleCheck, TriangleAlert } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import type { MapTrouble } from "@/api/types";
import type { Site } from "@/api/types";
import styles from "./robotmap.module.css";

function Trouble({ site, trouble }: { site: Site; trouble: MapTrouble }) {
  const { t } = useTranslation();
  const isMachine = trouble.kind === "machine";
  return (
    <li data-new={trouble.is_new || undefined}>
      {isMachine ? <Link to={`/sites/${site.slug}/devices/${trouble.id}`}>{trouble.name}</Link> : <b>{trouble.name}</b>}{" "}
      <span>{t(`robotMap.trouble.${isMachine ? "machine" : "place"}.${trouble.why}`)}</span>
      {trouble.is_new ? null : <small> {t("robotMap.trouble.already")}</small>}
    </li>
  );
}

export function MapTroubles({ site, troubles }: { site: Site; troubles: readonly MapTrouble[] }) {
  const { t } = useTranslation();
  const sorted = [...troubles].sort((a, b) => Number(b.is_new) - Number(a.is_new));
  const count = troubles.filter((each) => each.is_new).length;
  const Icon = count > 0 ? TriangleAlert : CircleCheck;
  return (
    <section className={styles.troubles} aria-labelledby="map-troubles">
      <h3 id="map-troubles" data-bad={count > 0 || undefined}>
        <Icon size={16} aria-hidden="true" />
        {count > 0 ? t("robotMap.trouble.some", { count }) : t("robotMap.trouble.none")}
      </h3>
      <ul>
        {sorted.map((trouble) => (
          <Trouble key={`${trouble.kind} ${trouble.id}`} site={site} trouble={trouble} />
        ))}
      </ul>
    </section>
  );
}
