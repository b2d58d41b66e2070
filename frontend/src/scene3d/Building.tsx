import { useEffect, useMemo, useRef } from "react";
import * as THREE from "three";
import { mergeCells } from "@/map/floor/floor";
import type { Palette } from "./palette";
import type { SceneMap } from "./types";

export const WALL_HEIGHT_M = 1.1;
const PIXELS_PER_METRE = 40;
const OCCUPIED = 100;
const UNKNOWN = 255;

function drawCells(context: CanvasRenderingContext2D, map: SceneMap, palette: Palette) {
  const side = map.resolution_m * PIXELS_PER_METRE;
  context.fillStyle = palette.floor;
  for (let row = 0; row < map.height; row += 1) {
    for (let column = 0; column < map.width; column += 1) {
      if (map.cells[row * map.width + column] === UNKNOWN) continue;
      context.fillRect(Math.floor(column * side), Math.floor((map.height - 1 - row) * side), side + 1, side + 1);
    }
  }
}

function drawGridAndNames(context: CanvasRenderingContext2D, map: SceneMap, palette: Palette) {
  const { width, height } = context.canvas;
  context.globalCompositeOperation = "source-atop";
  context.strokeStyle = palette.grid;
  context.lineWidth = 1;
  for (let x = Math.ceil(map.origin.x); (x - map.origin.x) * PIXELS_PER_METRE < width; x += 1) {
    const at = (x - map.origin.x) * PIXELS_PER_METRE;
    context.strokeRect(at, -1, 0, height + 2);
  }
  for (let y = Math.ceil(map.origin.y); (y - map.origin.y) * PIXELS_PER_METRE < height; y += 1) {
    const at = height - (y - map.origin.y) * PIXELS_PER_METRE;
    context.strokeRect(-1, at, width + 2, 0);
  }
  context.fillStyle = palette.text;
  context.font = `600 ${0.42 * PIXELS_PER_METRE}px Inter Variable, sans-serif`;
  context.letterSpacing = "3px";
  for (const place of map.places.filter((p) => p.kind === "room")) {
    const [labelX, labelY] = place.label ?? [place.x, place.y];
    const x = (labelX - map.origin.x) * PIXELS_PER_METRE;
    context.textAlign = x > width * 0.85 ? "right" : "left";
    context.fillText(place.name.toUpperCase(), x, height - (labelY - map.origin.y) * PIXELS_PER_METRE);
  }
}

/** The floor as a picture: the cells that are known, a metre grid, the rooms' names. */
function useFloorTexture(map: SceneMap, palette: Palette): THREE.Texture {
  const texture = useMemo(() => {
    const canvas = document.createElement("canvas");
    canvas.width = Math.max(1, Math.round(map.width * map.resolution_m * PIXELS_PER_METRE));
    canvas.height = Math.max(1, Math.round(map.height * map.resolution_m * PIXELS_PER_METRE));
    const context = canvas.getContext("2d");
    if (context) {
      drawCells(context, map, palette);
      drawGridAndNames(context, map, palette);
    }
    const made = new THREE.CanvasTexture(canvas);
    made.colorSpace = THREE.SRGBColorSpace;
    made.anisotropy = 8;
    return made;
  }, [map, palette]);
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

/** The floor and the walls of the place, extruded from its map. */
export function Building({ map, palette }: { map: SceneMap; palette: Palette }) {
  const texture = useFloorTexture(map, palette);
  const boxes = useMemo(() => wallBoxes(map), [map]);
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
      <mesh
        rotation={[-Math.PI / 2, 0, 0]}
        position={[map.origin.x + width / 2, 0, -(map.origin.y + depth / 2)]}
        receiveShadow
      >
        <planeGeometry args={[width, depth]} />
        <meshStandardMaterial map={texture} transparent alphaTest={0.5} roughness={0.95} />
      </mesh>
      <instancedMesh
        key={`w${boxes.length}`}
        ref={walls}
        args={[undefined, undefined, boxes.length]}
        castShadow
        receiveShadow
        frustumCulled={false}
      >
        <boxGeometry />
        <meshStandardMaterial color={palette.wall} roughness={0.9} />
      </instancedMesh>
      <instancedMesh
        key={`c${boxes.length}`}
        ref={caps}
        args={[undefined, undefined, boxes.length]}
        frustumCulled={false}
      >
        <boxGeometry />
        <meshStandardMaterial color={palette.wallTop} roughness={0.8} />
      </instancedMesh>
    </group>
  );
}
