/** What robots look like. */
import * as THREE from "three";
import type { Palette } from "../palette";
import { mergeSolids, type Solid } from "../solids";

const DECKS_M = [0.06, 0.2, 0.34];
const POSTS_AT = [0.7, 2.4, 3.9, 5.5];

/** A TurtleBot of this radius that looks along x: three decks and four posts. */
export function turtleGeometry(radius: number, palette: Palette): THREE.BufferGeometry {
  const decks: Solid[] = DECKS_M.map((y, index) => ({
    at: [0, y, 0],
    can: { radius: radius * (1 - index * 0.08), height: 0.05, sides: 22 },
    color: index === 0 ? palette.bodyDark : palette.body,
  }));
  const posts: Solid[] = POSTS_AT.map((angle) => ({
    at: [Math.cos(angle) * radius * 0.7, 0.2, Math.sin(angle) * radius * 0.7],
    can: { radius: 0.012, height: 0.32, sides: 4 },
    color: palette.bodyDark,
  }));
  return mergeSolids([...decks, ...posts]);
}

/** The sign on its top deck that says where its front is. */
export const frontGeometry = (radius: number): THREE.BufferGeometry =>
  new THREE.BoxGeometry(radius * 0.3, 0.04, radius * 0.3).translate(radius * 0.75, 0.38, 0);

/** The dark on the floor below it: what moves casts no shadow of its own, so that those of the rest are drawn once. */
export const shadowGeometry = (radius: number): THREE.BufferGeometry =>
  new THREE.CircleGeometry(radius * 1.2, 28).rotateX(-Math.PI / 2).translate(0, 0.011, 0);

const LOAD_M = 0.5;

export const boxGeometry = (palette: Palette): THREE.BufferGeometry =>
  mergeSolids([{ at: [0, LOAD_M, 0], box: [0.24, 0.22, 0.24], color: palette.warnFill }]);

export const canGeometry = (palette: Palette): THREE.BufferGeometry =>
  mergeSolids([{ at: [0, LOAD_M, 0], can: { radius: 0.1, height: 0.24, sides: 22 }, color: palette.machine }]);
