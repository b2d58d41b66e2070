/** The lamps of all machines: two calls draw them, however many there are. */
import { useFrame } from "@react-three/fiber";
import { type RefObject, useEffect, useMemo, useRef } from "react";
import * as THREE from "three";
import { ownEntry } from "@/design/ownEntry";
import { latest } from "../frames";
import type { Palette } from "../palette";
import type { Moment, SceneDevice, SceneRecording } from "../types";
import { LAMP_HEIGHT_M, lampAt } from "./bodies";

interface LampsProps {
  machines: readonly SceneDevice[];
  recording: SceneRecording | null;
  moment: Moment;
  palette: Palette;
}

const RADIUS_M = 0.13;
const HALO_M = 0.3;
const TOP_M = LAMP_HEIGHT_M + 0.1;
const BOTTOM_M = LAMP_HEIGHT_M - 0.2;
const UP = new THREE.Vector3(0, 1, 0);

interface Colours {
  on: THREE.Color;
  off: THREE.Color;
}

const lit = (color: string): Colours => ({
  on: new THREE.Color(color).offsetHSL(0, 0.1, 0.14),
  off: new THREE.Color(color).lerp(new THREE.Color("#20242e"), 0.7),
});

/** Where a machine's lamp stands, at a height above the floor. */
function spotOf({ size, location }: SceneDevice, height_m: number): THREE.Matrix4 {
  const [x, z] = lampAt(size);
  const at = new THREE.Vector3(x, height_m, z).applyAxisAngle(UP, location.theta);
  return new THREE.Matrix4().setPosition(at.x + location.x, at.y, at.z - location.y);
}

interface Shown {
  at: THREE.Matrix4;
  color: THREE.Color;
}

function show({ current: mesh }: RefObject<THREE.InstancedMesh | null>, lamps: readonly Shown[]): void {
  if (!mesh) return;
  for (const [index, { at, color }] of lamps.entries()) {
    mesh.setMatrixAt(index, at);
    mesh.setColorAt(index, color);
  }
  mesh.instanceMatrix.needsUpdate = true;
  if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
}

/** The top lamp of each machine is lit while it is not done, the bottom lamp while it is; the lit one has a halo. */
export function Lamps({ machines, recording, moment, palette }: LampsProps) {
  const bulbs = useRef<THREE.InstancedMesh>(null);
  const halos = useRef<THREE.InstancedMesh>(null);
  const shown = useRef("");
  const { top, bottom } = useMemo(() => ({ top: lit(palette.error), bottom: lit(palette.done) }), [palette]);
  const spots = useMemo(
    () => machines.map((each) => ({ up: spotOf(each, TOP_M), down: spotOf(each, BOTTOM_M) })),
    [machines],
  );
  useEffect(() => {
    shown.current = "";
  }, [spots, top, bottom]);
  useFrame(() => {
    const busy = machines.map(({ id }) => latest(ownEntry(recording?.machine_states, id), moment.t_s)?.[1] ?? false);
    if (shown.current === busy.join()) return;
    shown.current = busy.join();
    const lamps = spots.flatMap(({ up, down }, index) => [
      { at: up, color: busy[index] ? top.on : top.off },
      { at: down, color: busy[index] ? bottom.off : bottom.on },
    ]);
    show(bulbs, lamps);
    show(
      halos,
      lamps.filter(({ color }) => color === top.on || color === bottom.on),
    );
  });
  const count = machines.length;
  return (
    <>
      <instancedMesh key={`b${count}`} ref={bulbs} args={[undefined, undefined, 2 * count]} frustumCulled={false}>
        <sphereGeometry args={[RADIUS_M, 10, 7]} />
        <meshBasicMaterial toneMapped={false} />
      </instancedMesh>
      <instancedMesh key={`h${count}`} ref={halos} args={[undefined, undefined, count]} frustumCulled={false}>
        <sphereGeometry args={[HALO_M, 10, 7]} />
        <meshBasicMaterial toneMapped={false} transparent opacity={palette.dark ? 0.22 : 0.16} depthWrite={false} />
      </instancedMesh>
    </>
  );
}
