/** What lies in the way of simulated robots, as a list; who runs programs puts it there and takes it away. */
import { Button } from "@mantine/core";
import { TrafficCone, Trash2, X } from "lucide-react";
import { useTranslation } from "react-i18next";
import type { SiteMap } from "@/api/types";
import { IconButton } from "@/design/IconButton";
import { NumberField } from "@/design/NumberField";
import places from "../places/places.module.css";
import styles from "./obstacles.module.css";
import { obstacleWords } from "./obstacleWords";
import type { ObstacleEditing } from "./useObstacles";

const [SMALLEST_M, LARGEST_M] = [0.1, 2];

interface ObstaclesPanelProps {
  map: SiteMap;
  /** Null for who only looks. */
  editing: ObstacleEditing | null;
}

export function ObstaclesPanel({ map, editing }: ObstaclesPanelProps) {
  const { t } = useTranslation();
  if (!editing && map.obstacles.length === 0) return null;
  return (
    <section aria-labelledby="obstacles">
      <h2 id="obstacles">{t("obstacle.obstacles")}</h2>
      {editing ? <Adding editing={editing} /> : <p className={places.quiet}>{t("obstacle.simulatedOnly")}</p>}
      {map.obstacles.length === 0 ? <p className={places.quiet}>{t("obstacle.none")}</p> : null}
      <ul className={places.list}>
        {map.obstacles.map((obstacle) => {
          const words = obstacleWords(obstacle);
          return (
            <li key={obstacle.id} className={styles.row}>
              <span>{words}</span>
              {editing ? (
                <IconButton label={t("obstacle.removeOne", { words })} onClick={() => editing.remove(obstacle.id)}>
                  <Trash2 size={16} aria-hidden="true" />
                </IconButton>
              ) : null}
            </li>
          );
        })}
      </ul>
      {editing && map.obstacles.length > 1 ? (
        <Button
          mt={8}
          variant="default"
          leftSection={<Trash2 size={16} aria-hidden="true" />}
          onClick={editing.removeAll}
        >
          {t("obstacle.removeAll")}
        </Button>
      ) : null}
    </section>
  );
}

function Adding({ editing }: { editing: ObstacleEditing }) {
  const { t } = useTranslation();
  const { adding, begin, stop, size_m, setSize } = editing;
  const Icon = adding ? X : TrafficCone;
  return (
    <div className={places.adding}>
      <p id="obstacles-help" className={places.quiet}>
        {t(adding ? "obstacle.putHelp" : "obstacle.help")}
      </p>
      <p className={places.quiet}>{t("obstacle.simulatedOnly")}</p>
      <NumberField
        label={t("obstacle.size")}
        value={size_m}
        min={SMALLEST_M}
        max={LARGEST_M}
        step={0.1}
        decimalScale={2}
        suffix=" m"
        onChange={(value) => {
          if (typeof value === "number") setSize(value);
        }}
      />
      <Button
        variant={adding ? "default" : "light"}
        leftSection={<Icon size={16} aria-hidden="true" />}
        onClick={adding ? stop : begin}
      >
        {t(adding ? "obstacle.addStop" : "obstacle.add")}
      </Button>
    </div>
  );
}
