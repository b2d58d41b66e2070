/** Of a zone that robots are let into: whether it is open to all of them, who is in it, and what opens and shuts it. */
import { Button, Group } from "@mantine/core";
import { Lock } from "lucide-react";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { useSite } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { MapZone } from "@/api/types";
import { useChangeZone } from "@/api/zones";
import { formatTime } from "@/i18n/format";
import { liveRobots } from "@/live/robots";
import { openUntil } from "@/map/floor/openZones";
import { OpenZoneMenu } from "@/shell/admissions/OpenZoneMenu";
import { tellRefusal } from "@/shell/refusal";
import { holds } from "./outline";
import styles from "./zones.module.css";

/** How often it is looked who is in a zone, milliseconds. */
const LOOK_EVERY_MS = 500;

interface ReleasedZoneProps {
  slug: string;
  zone: MapZone;
  /** The time at which it is shown, milliseconds. */
  at: number;
}

export function ReleasedZone({ slug, zone, at }: ReleasedZoneProps) {
  const { t } = useTranslation();
  const until = openUntil(zone, at);
  const inside = useNamesInside(zone.points);
  const allowed = mayOperate(useSite(slug).data?.role);
  return (
    <div className={styles.released} data-open={until ? true : undefined}>
      <p>{until ? t("admission.opening.open", { time: formatTime(until) }) : t("admission.opening.shut")}</p>
      <p>{inside ? t("admission.opening.inside", { names: inside }) : t("admission.opening.nobody")}</p>
      {allowed ? (
        <Group gap={8}>
          <OpenZoneMenu slug={slug} zone={zone.id} name={zone.name} isOpen={until !== null} />
          {until ? <CloseButton slug={slug} zone={zone} /> : null}
        </Group>
      ) : null}
    </div>
  );
}

function CloseButton({ slug, zone }: { slug: string; zone: MapZone }) {
  const { t } = useTranslation();
  const change = useChangeZone(slug, (error) => tellRefusal(error, t));
  return (
    <Button
      variant="default"
      size="compact-md"
      loading={change.isPending}
      leftSection={<Lock size={14} aria-hidden="true" />}
      aria-label={t("admission.opening.of", { words: t("admission.opening.close"), zone: zone.name })}
      onClick={() => change.mutate({ do: "close", id: zone.id })}
    >
      {t("admission.opening.close")}
    </Button>
  );
}

/** The names of the robots in an outline now. */
function useNamesInside(points: MapZone["points"]): string {
  const [names, setNames] = useState("");
  useEffect(() => {
    const look = () => {
      const inside = liveRobots(performance.now()).filter(({ x, y }) => holds(points, [x, y]));
      setNames(inside.map(({ name }) => name).join(", "));
    };
    look();
    const timer = setInterval(look, LOOK_EVERY_MS);
    return () => clearInterval(timer);
  }, [points]);
  return names;
}
