/** Where the camera stands so that the whole place is in view. Pure. */
import * as THREE from "three";

/** So much of the picture the place may fill; the rest is for buttons and names. */
const FILLED = { across: 1, up: 0.86 };
const UP = new THREE.Vector3(0, 1, 0);

/**
 * How far from the middle of a place the camera stands, metres, so that all of its floor is seen.
 *
 * `from` points from the middle to the camera, `fov` is the angle from the picture's bottom to its top in degrees,
 * `aspect` how many times as wide as high it is.
 */
export function distanceFor(width: number, depth: number, from: THREE.Vector3, fov: number, aspect: number): number {
  const towards = from.clone().normalize();
  const right = new THREE.Vector3().crossVectors(UP, towards).normalize();
  const up = new THREE.Vector3().crossVectors(towards, right);
  const half = Math.tan(((fov / 2) * Math.PI) / 180);
  const corners = [-1, 1].flatMap((x) => [-1, 1].map((z) => new THREE.Vector3((x * width) / 2, 0, (z * depth) / 2)));
  return Math.max(
    ...corners.map((corner) => {
      const across = Math.abs(corner.dot(right)) / (half * aspect * FILLED.across);
      const high = Math.abs(corner.dot(up)) / (half * FILLED.up);
      return Math.max(across, high) + corner.dot(towards);
    }),
  );
}
