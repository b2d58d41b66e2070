/** Many lines on the floor that change often, drawn by one call: their buffer is kept and written over. */
import * as THREE from "three";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

type Point = readonly [x: number, y: number];

const FIRST_CAPACITY = 256;
const NUMBERS = 6;

/** Pieces of lines at one height; the distance along each line is kept for dashes. */
export class FloorLines {
  readonly geometry = new LineSegmentsGeometry();
  private places = new THREE.InstancedInterleavedBuffer(new Float32Array(0), NUMBERS, 1);
  private distances = new THREE.InstancedInterleavedBuffer(new Float32Array(0), 2, 1);
  private capacity = 0;

  constructor(private readonly height_m: number) {
    this.reserve(FIRST_CAPACITY);
    this.geometry.instanceCount = 0;
  }

  /** Show these lines, each a list of points in metres of the map, instead of those before. */
  write(lines: readonly (readonly Point[])[]): void {
    const pieces = lines.reduce((sum, line) => sum + Math.max(0, line.length - 1), 0);
    if (pieces > this.capacity) this.reserve(Math.max(pieces, this.capacity * 2));
    let at = 0;
    for (const line of lines) at = this.writeLine(line, at);
    this.geometry.instanceCount = pieces;
    for (const [buffer, numbers] of [[this.places, NUMBERS] as const, [this.distances, 2] as const]) {
      buffer.clearUpdateRanges();
      buffer.addUpdateRange(0, pieces * numbers);
      buffer.needsUpdate = true;
    }
  }

  private writeLine(line: readonly Point[], first: number): number {
    let along_m = 0;
    let at = first;
    for (let index = 1; index < line.length; index += 1) {
      const [from, to] = [line[index - 1], line[index]];
      if (!from || !to) continue;
      const end_m = along_m + Math.hypot(to[0] - from[0], to[1] - from[1]);
      this.places.array.set([from[0], this.height_m, -from[1], to[0], this.height_m, -to[1]], at * NUMBERS);
      this.distances.array.set([along_m, end_m], at * 2);
      along_m = end_m;
      at += 1;
    }
    return at;
  }

  /** New buffers have to be new attributes of a geometry that has let the old ones go. */
  private reserve(capacity: number): void {
    this.geometry.dispose();
    this.capacity = capacity;
    this.places = new THREE.InstancedInterleavedBuffer(new Float32Array(capacity * NUMBERS), NUMBERS, 1);
    this.distances = new THREE.InstancedInterleavedBuffer(new Float32Array(capacity * 2), 2, 1);
    for (const buffer of [this.places, this.distances]) buffer.setUsage(THREE.DynamicDrawUsage);
    const parts = { instanceStart: 0, instanceEnd: 3 };
    for (const [name, offset] of Object.entries(parts))
      this.geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(this.places, 3, offset));
    this.geometry.setAttribute("instanceDistanceStart", new THREE.InterleavedBufferAttribute(this.distances, 1, 0));
    this.geometry.setAttribute("instanceDistanceEnd", new THREE.InterleavedBufferAttribute(this.distances, 1, 1));
  }
}
