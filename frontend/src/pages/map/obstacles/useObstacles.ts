/** What somebody does with the obstacles on a floor at the moment. */
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { useChangeObstacles } from "@/api/obstacles";
import type { Point } from "@/map/plane/projection";
import { tellRefusal } from "@/shell/refusal";

export type ObstacleEditing = ReturnType<typeof useObstacles>;

const USUAL_M = 0.5;

/** `adding` is true while a click on the floor puts one more there; `size_m` is how wide the next one is. */
export function useObstacles(slug: string) {
  const { t } = useTranslation();
  const change = useChangeObstacles(slug, (error) => tellRefusal(error, t));
  const [adding, setAdding] = useState(true);
  const [size_m, setSize] = useState(USUAL_M);
  return {
    adding,
    begin: () => setAdding(true),
    stop: () => setAdding(false),
    size_m,
    setSize,
    put: ([x, y]: Point) => change.mutate({ do: "add", obstacle: { x, y, size_m } }),
    remove: (id: number) => change.mutate({ do: "remove", id }),
    removeAll: () => change.mutate({ do: "removeAll" }),
  };
}
