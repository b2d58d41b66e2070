import { useFrame } from "@react-three/fiber";
import { useRef } from "react";
import type * as THREE from "three";
import { latest } from "./frames";
import { bodyFor } from "./bodies";
import type { Palette } from "./palette";
import type { Moment, SceneDevice, SceneRecording } from "./types";

const LAMP_HEIGHT_M = 1.9;

interface MachineProps {
  device: SceneDevice;
  recording: SceneRecording | null;
  moment: Moment;
  palette: Palette;
}

/** The lamp post: the top lamp is lit while a machine is not done, the bottom lamp while it is. */
function Lamps({ device, recording, moment, palette }: MachineProps) {
  const top = useRef<THREE.MeshStandardMaterial>(null);
  const bottom = useRef<THREE.MeshStandardMaterial>(null);
  useFrame(() => {
    const busy = latest(recording?.machine_states[device.id], moment.t_s)?.[1] ?? false;
    if (top.current) top.current.emissiveIntensity = busy ? 2.2 : 0;
    if (bottom.current) bottom.current.emissiveIntensity = busy ? 0 : 1.6;
  });
  return (
    <group position={[device.size.x / 2 + 0.18, 0, device.size.y / 2 + 0.05]}>
      <mesh position={[0, LAMP_HEIGHT_M / 2, 0]}>
        <cylinderGeometry args={[0.03, 0.03, LAMP_HEIGHT_M, 8]} />
        <meshStandardMaterial color={palette.bodyDark} />
      </mesh>
      <mesh position={[0, LAMP_HEIGHT_M + 0.1, 0]}>
        <sphereGeometry args={[0.13, 16, 12]} />
        <meshStandardMaterial ref={top} color={palette.error} emissive={palette.error} emissiveIntensity={0} />
      </mesh>
      <mesh position={[0, LAMP_HEIGHT_M - 0.2, 0]}>
        <sphereGeometry args={[0.13, 16, 12]} />
        <meshStandardMaterial ref={bottom} color={palette.done} emissive={palette.done} emissiveIntensity={1.6} />
      </mesh>
    </group>
  );
}

/** The yellow line on the floor around a machine. */
function FloorLine({ device, palette }: { device: SceneDevice; palette: Palette }) {
  const [w, d, t] = [device.size.x + 0.5, device.size.y + 0.5, 0.05];
  const bars: [number, number, number, number][] = [
    [0, d / 2, w, t],
    [0, -d / 2, w, t],
    [w / 2, 0, t, d],
    [-w / 2, 0, t, d],
  ];
  return (
    <>
      {bars.map(([x, z, width, depth]) => (
        <mesh key={`${x},${z}`} position={[x, 0.012, z]}>
          <boxGeometry args={[width, 0.01, depth]} />
          <meshStandardMaterial color={palette.warnFill} />
        </mesh>
      ))}
    </>
  );
}

/** A machine at its place, with a body of its class and its lamps. */
export function Machine(props: MachineProps) {
  const { device, palette } = props;
  const Body = bodyFor(device.device_class);
  return (
    <group position={[device.location.x, 0, -device.location.y]} rotation={[0, device.location.theta, 0]}>
      <FloorLine device={device} palette={palette} />
      <Body size={device.size} palette={palette} />
      <Lamps {...props} />
    </group>
  );
}
