import { useEffect, useMemo, useRef } from "react";
import * as THREE from "three";
import { mergeCells } from "@/map/floor/floor";
import { drawFloor, pixelsPerMetre } from "./floorPicture";
import type { Palette } from "./palette";
import type { Prism } from "./shadows";
import type { SceneMap } from "./types";

export const WALL_HEIGHT_M = 1.1;
const OCCUPIED = 100;

/** The floor as a picture: the cells that are known, a metre grid, the rooms' names, what lies in the shadow. */
function useFloorTexture(map: SceneMap, palette: Palette, prisms: readonly Prism[]): THREE.Texture {
  const texture = useMemo(() => {
    const canvas = document.createElement("canvas");
    canvas.width = Math.max(1, Math.round(map.width * map.resolution_m * pixelsPerMetre(map)));
    canvas.height = Math.max(1, Math.round(map.height * map.resolution_m * pixelsPerMetre(map)));
    const context = canvas.getContext("2d");
    if (context) drawFloor(context, map, palette, prisms);
    const made = new THREE.CanvasTexture(canvas);
    made.colorSpace = THREE.SRGBColorSpace;
    made.anisotropy = 4;
    return made;
  }, [map, palette, prisms]);
  useEffect(() => () => texture.dispose(), [texture]);
  return texture;
}

/** The walls as few boxes, in metres. */
function wallBoxes(map: SceneMap) {
  const side = map.resolution_m;
  return mergeCells(map, (cell) => cell === OCCUPIED).map((box) => {
    const x1 = map.origin.x + box.column * side;
    const y1 = map.origin.y + box.row * side;
    return { x1, y1, x2: x1 + box.columns * side, y2: y1 + box.rows * side };
  });
}

type WallBox = ReturnType<typeof wallBoxes>[number];

const prismOfWall = ({ x1, y1, x2, y2 }: WallBox): Prism => ({
  corners: [
    [x1, y1],
    [x2, y1],
    [x2, y2],
    [x1, y2],
  ],
  from_m: 0,
  to_m: WALL_HEIGHT_M,
});

interface BuildingProps {
  map: SceneMap;
  palette: Palette;
  /** What else throws a shadow. */
  standing: readonly Prism[];
}

/** The floor and the walls of the place, extruded from its map. */
export function Building({ map, palette, standing }: BuildingProps) {
  const boxes = useMemo(() => wallBoxes(map), [map]);
  const prisms = useMemo(() => [...boxes.map(prismOfWall), ...standing], [boxes, standing]);
  const texture = useFloorTexture(map, palette, prisms);
  const walls = useRef<THREE.InstancedMesh>(null);
  const caps = useRef<THREE.InstancedMesh>(null);
  useEffect(() => {
    const matrix = new THREE.Matrix4();
    boxes.forEach((box, index) => {
      const x = (box.x1 + box.x2) / 2;
      const z = -(box.y1 + box.y2) / 2;
      matrix.makeScale(box.x2 - box.x1, WALL_HEIGHT_M, box.y2 - box.y1).setPosition(x, WALL_HEIGHT_M / 2, z);
      walls.current?.setMatrixAt(index, matrix);
      matrix.makeScale(box.x2 - box.x1, 0.02, box.y2 - box.y1).setPosition(x, WALL_HEIGHT_M + 0.01, z);
      caps.current?.setMatrixAt(index, matrix);
    });
    for (const mesh of [walls.current, caps.current]) if (mesh) mesh.instanceMatrix.needsUpdate = true;
  }, [boxes]);
  const width = map.width * map.resolution_m;
  const depth = map.height * map.resolution_m;
  return (
    <group>
      <mesh rotation={[-Math.PI / 2, 0, 0]} position={[map.origin.x + width / 2, 0, -(map.origin.y + depth / 2)]}>
        <planeGeometry args={[width, depth]} />
        <meshLambertMaterial map={texture} transparent alphaTest={0.5} />
      </mesh>
      <instancedMesh
        key={`w${boxes.length}`}
        ref={walls}
        args={[undefined, undefined, boxes.length]}
        frustumCulled={false}
      >
        <boxGeometry />
        <meshLambertMaterial color={palette.wall} />
      </instancedMesh>
      <instancedMesh
        key={`c${boxes.length}`}
        ref={caps}
        args={[undefined, undefined, boxes.length]}
        frustumCulled={false}
      >
        <boxGeometry />
        <meshLambertMaterial color={palette.wallTop} />
      </instancedMesh>
    </group>
  );
}
