/** All machines at their places: those that look the same are drawn together, however many there are. */
import { useEffect, useMemo, useRef } from "react";
import * as THREE from "three";
import { byLook } from "../alike";
import type { Palette } from "../palette";
import { mergeSolids } from "../solids";
import type { SceneDevice } from "../types";
import { bodyOf, type Glowing, surroundingsOf } from "./bodies";

const UP = new THREE.Vector3(0, 1, 0);
const AS_IT_IS = new THREE.Vector3(1, 1, 1);

function matrixOf({ location }: SceneDevice): THREE.Matrix4 {
  const turned = new THREE.Quaternion().setFromAxisAngle(UP, location.theta);
  return new THREE.Matrix4().compose(new THREE.Vector3(location.x, 0, -location.y), turned, AS_IT_IS);
}

/** A mesh that is at all these machines. */
function useAtEach(machines: readonly SceneDevice[]) {
  const mesh = useRef<THREE.InstancedMesh>(null);
  useEffect(() => {
    machines.forEach((device, index) => mesh.current?.setMatrixAt(index, matrixOf(device)));
    if (mesh.current) mesh.current.instanceMatrix.needsUpdate = true;
  }, [machines]);
  return mesh;
}

function Shining({ part, machines }: { part: Glowing; machines: readonly SceneDevice[] }) {
  const mesh = useAtEach(machines);
  const { at, box, color, glow } = part;
  const geometry = useMemo(() => new THREE.BoxGeometry(...box).translate(...at), [at, box]);
  useEffect(() => () => geometry.dispose(), [geometry]);
  return (
    <instancedMesh ref={mesh} args={[geometry, undefined, machines.length]} frustumCulled={false}>
      <meshLambertMaterial color={color} emissive={color} emissiveIntensity={glow} />
    </instancedMesh>
  );
}

/** Machines of one class and size. */
function Alike({ machines, palette }: MachinesProps) {
  const [first] = machines;
  const mesh = useAtEach(machines);
  const { solids, glowing } = useMemo(
    () => (first ? bodyOf(first.device_class, first.size, palette) : { solids: [], glowing: [] }),
    [first, palette],
  );
  const geometry = useMemo(
    () => mergeSolids(first ? [...solids, ...surroundingsOf(first.size, palette)] : []),
    [solids, first, palette],
  );
  useEffect(() => () => geometry.dispose(), [geometry]);
  return (
    <>
      <instancedMesh ref={mesh} args={[geometry, undefined, machines.length]} frustumCulled={false}>
        <meshLambertMaterial vertexColors />
      </instancedMesh>
      {glowing.map((part, index) => (
        <Shining key={index} part={part} machines={machines} />
      ))}
    </>
  );
}

interface MachinesProps {
  machines: readonly SceneDevice[];
  palette: Palette;
}

const looks = ({ device_class, size }: SceneDevice) => JSON.stringify([device_class, size.x, size.y, size.z]);

export function Machines({ machines, palette }: MachinesProps) {
  const alike = useMemo(() => byLook(machines, looks), [machines]);
  return alike.map(([look, of]) => <Alike key={`${look} ${of.length}`} machines={of} palette={palette} />);
}
