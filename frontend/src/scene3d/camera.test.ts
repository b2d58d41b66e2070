import * as THREE from "three";
import { expect, test } from "vitest";
import { distanceFor } from "./camera";

test.each([
  ["the factory", 25, 14, 1.15],
  ["a hall", 112, 74, 1.15],
  ["a corridor on a tablet", 60, 4, 2.2],
  ["a deep hall on a narrow screen", 10, 80, 0.7],
])("all corners of %s are in the picture, and the place fills it one way", (_, width, depth, aspect) => {
  for (const from of [new THREE.Vector3(-0.22, 0.72, 0.66), new THREE.Vector3(0, 1, 0.001)]) {
    const camera = new THREE.PerspectiveCamera(38, aspect, 0.1, 4000);
    camera.position.copy(from).setLength(distanceFor(width, depth, from, 38, aspect));
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    const seen = [-1, 1].flatMap((x) =>
      [-1, 1].map((z) => new THREE.Vector3((x * width) / 2, 0, (z * depth) / 2).project(camera)),
    );
    const [across, high] = [
      Math.max(...seen.map(({ x }) => Math.abs(x))),
      Math.max(...seen.map(({ y }) => Math.abs(y))),
    ];
    expect(across).toBeLessThanOrEqual(1.001);
    expect(high).toBeLessThanOrEqual(0.861);
    expect(across > 0.99 || high > 0.85).toBe(true);
  }
});
