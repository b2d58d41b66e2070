/** The floor that the camera of the 3D view looks at. */
import { useMemo } from "react";
import * as THREE from "three";
import type { SceneMap } from "./types";

/** The map's middle and sides (m) in the scene: the same object as long as the map lies as it did, whatever is on it. */
export function useArea({ width, height, resolution_m, origin: { x, y } }: SceneMap) {
  return useMemo(() => {
    const [wide, deep] = [width * resolution_m, height * resolution_m];
    return { centre: new THREE.Vector3(x + wide / 2, 0, -(y + deep / 2)), width: wide, depth: deep };
  }, [width, height, resolution_m, x, y]);
}
