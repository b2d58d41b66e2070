/** Names of devices over the picture: text of the page, moved once for each picture that is drawn. */
import { useFrame } from "@react-three/fiber";
import { memo, type RefObject } from "react";
import * as THREE from "three";
import { poseAt } from "../frames";
import styles from "../Scene3D.module.css";
import type { Moment, SceneDevice, SceneRecording } from "../types";
import { type Name, placesOf } from "./places";

const MACHINE_HEIGHT_M = 1.9;
const ROBOT_HEIGHT_M = 1.5;

interface TagProps {
  device: SceneDevice;
  state: string;
}

const Tag = memo(function Tag({ device, state }: TagProps) {
  return (
    <span className={device.kind === "robot" ? styles.robotLabel : styles.label} data-device={device.id}>
      <b>{device.name}</b> {state}
    </span>
  );
});

interface NameTagsProps {
  devices: readonly SceneDevice[];
  stateOf?: (device: string) => string;
}

/** The names, wherever `NamePlaces` puts them. */
export function NameTags({ devices, stateOf }: NameTagsProps) {
  return devices.map((device) => <Tag key={device.id} device={device} state={stateOf?.(device.id) ?? ""} />);
}

interface NamePlacesProps {
  devices: readonly SceneDevice[];
  recording: SceneRecording | null;
  moment: Moment;
  /** What the names stand in. */
  layer: RefObject<HTMLDivElement | null>;
}

function above(device: SceneDevice, recording: SceneRecording | null, t_s: number, into: THREE.Vector3): void {
  const { x, y } = device.location;
  if (device.kind !== "robot") into.set(x, MACHINE_HEIGHT_M, -y);
  else {
    const pose = recording ? poseAt(recording.frames, device.id, t_s) : null;
    into.set(pose?.[0] ?? x, ROBOT_HEIGHT_M, -(pose?.[1] ?? y));
  }
}

const POINT = new THREE.Vector3();

interface Seen extends Name {
  tag: HTMLElement;
  depth: number;
}

/** How large each name is, measured anew when its text is another. */
const sizes = new WeakMap<HTMLElement, { text: string; width: number; height: number }>();

function sizeOf(tag: HTMLElement) {
  const text = tag.textContent;
  const known = sizes.get(tag);
  if (known?.text === text) return known;
  const size = { text, width: tag.offsetWidth, height: tag.offsetHeight };
  sizes.set(tag, size);
  return size;
}

/** Puts each name above its device and off those before it, robots first; those that find no place, or are out of view, are hidden. */
export function NamePlaces({ devices, recording, moment, layer }: NamePlacesProps) {
  useFrame(({ camera, size }) => {
    const seen: Seen[] = [];
    for (const [index, tag] of [...(layer.current?.children ?? [])].entries()) {
      const device = devices[index];
      if (!(tag instanceof HTMLElement) || !device || tag.dataset.device !== device.id) continue;
      above(device, recording, moment.t_s, POINT);
      POINT.project(camera);
      if (Math.abs(POINT.z) > 1 || Math.abs(POINT.x) > 1.2 || Math.abs(POINT.y) > 1.2) {
        put(tag, "", 0);
        continue;
      }
      const x = Math.round(((POINT.x + 1) / 2) * size.width);
      const own = sizeOf(tag);
      const y = Math.round(((1 - POINT.y) / 2) * size.height - own.height / 2);
      seen.push({ tag, x, y, ...own, depth: Math.round((1 - POINT.z) * 1000) });
    }
    for (const [index, up] of placesOf(seen).entries()) {
      const name = seen[index];
      if (!name) continue;
      const at = `translate(${name.x}px, ${name.y - (up ?? 0)}px) translate(-50%, -50%)`;
      put(name.tag, up === null ? "" : at, name.depth);
    }
  });
  return null;
}

/** Writes only what has changed: each writing makes the page reckon its styles anew. */
function put(tag: HTMLElement, transform: string, depth: number): void {
  const { style } = tag;
  if (transform && style.transform !== transform) style.transform = transform;
  const [visibility, zIndex] = [transform ? "visible" : "hidden", String(depth)];
  if (style.visibility !== visibility) style.visibility = visibility;
  if (style.zIndex !== zIndex) style.zIndex = zIndex;
}
