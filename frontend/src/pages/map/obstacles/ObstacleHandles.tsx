/** The obstacles over the map while somebody puts them there, and the floor on which the next one is put. */
import type { KeyboardEvent } from "react";
import { useTranslation } from "react-i18next";
import { useChangeObstacles } from "@/api/obstacles";
import type { Obstacle, SiteMap } from "@/api/types";
import { PIXELS_PER_METRE, toPixels } from "@/map/plane/projection";
import { tellRefusal } from "@/shell/refusal";
import { movedByKey, useDraftPoint, useDragging } from "../../devices/movable";
import { FloorTool } from "../FloorTool";
import styles from "./obstacles.module.css";
import { obstacleWords } from "./obstacleWords";
import type { ObstacleEditing } from "./useObstacles";

/** Drawing pixels: a finger finds it, too. */
const REACH = 24;

interface HandlesProps {
  slug: string;
  map: SiteMap;
  editing: ObstacleEditing;
}

export function ObstacleHandles({ slug, map, editing }: HandlesProps) {
  const { t } = useTranslation();
  return (
    <>
      {editing.adding ? <FloorTool map={map} label={t("obstacle.put")} put={editing.put} stop={editing.stop} /> : null}
      {map.obstacles.map((obstacle) => (
        <MovableObstacle key={obstacle.id} slug={slug} map={map} obstacle={obstacle} editing={editing} />
      ))}
    </>
  );
}

interface MovableObstacleProps extends HandlesProps {
  obstacle: Obstacle;
}

function MovableObstacle({ slug, map, obstacle, editing }: MovableObstacleProps) {
  const { t } = useTranslation();
  const change = useChangeObstacles(slug, (error) => tellRefusal(error, t));
  const { id, size_m } = obstacle;
  const draft = useDraftPoint(map, [obstacle.x, obstacle.y], change.isPending, ([x, y], done) =>
    change.mutate({ do: "move", id, obstacle: { x, y, size_m } }, done),
  );
  const { at, keep } = draft;
  const pixel = toPixels(at);
  const radius = (size_m / 2) * PIXELS_PER_METRE;
  const arm = radius * Math.SQRT1_2;
  const press = (event: KeyboardEvent) => {
    if (event.key !== "Delete" && event.key !== "Backspace") return movedByKey(event, draft);
    event.preventDefault();
    editing.remove(id);
  };
  return (
    <g
      transform={`translate(${pixel.x} ${pixel.y})`}
      className={styles.handle}
      role="button"
      tabIndex={0}
      aria-label={obstacleWords({ ...obstacle, x: at[0], y: at[1] })}
      aria-describedby="obstacles-help"
      {...useDragging(draft)}
      onKeyDown={press}
      onBlur={keep}
    >
      <circle className={styles.reach} r={Math.max(radius, REACH)} />
      <circle className={styles.body} r={radius} />
      <path className={styles.cross} d={`M${-arm} ${-arm}L${arm} ${arm}M${-arm} ${arm}L${arm} ${-arm}`} />
    </g>
  );
}
