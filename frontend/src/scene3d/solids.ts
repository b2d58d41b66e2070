/** Bodies of boxes and cans as one geometry with the colours in its vertices, so that one call draws a whole body. */
import * as THREE from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

type Triple = readonly [x: number, y: number, z: number];

/** A box or an upright can, around its middle, in metres; `turn` in radians about the three axes. */
export interface Solid {
  readonly at: Triple;
  readonly color: string;
  readonly turn?: Triple;
  readonly box?: Triple;
  readonly can?: { readonly radius: number; readonly height: number; readonly sides?: number };
}

const USUAL_SIDES = 24;

function geometryOf({ at, turn, box, can }: Solid): THREE.BufferGeometry {
  const geometry = can
    ? new THREE.CylinderGeometry(can.radius, can.radius, can.height, can.sides ?? USUAL_SIDES)
    : new THREE.BoxGeometry(...(box ?? ([0, 0, 0] as const)));
  const matrix = new THREE.Matrix4();
  if (turn) matrix.makeRotationFromEuler(new THREE.Euler(...turn));
  return geometry.applyMatrix4(matrix.setPosition(...at));
}

/** One geometry of all solids; who has it disposes of it. */
export function mergeSolids(solids: readonly Solid[]): THREE.BufferGeometry {
  if (solids.length === 0) return new THREE.BufferGeometry();
  const pieces = solids.map((solid) => {
    const geometry = geometryOf(solid);
    const { r, g, b } = new THREE.Color(solid.color);
    const vertices = geometry.getAttribute("position").count;
    const colors = new Float32Array(vertices * 3);
    for (let index = 0; index < vertices; index += 1) colors.set([r, g, b], index * 3);
    geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
    geometry.deleteAttribute("uv");
    return geometry;
  });
  const merged = mergeGeometries(pieces);
  for (const piece of pieces) piece.dispose();
  return merged;
}
