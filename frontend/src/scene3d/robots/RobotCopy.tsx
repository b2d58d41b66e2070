import { useFrame } from "@react-three/fiber";
import { useRef } from "react";
import type * as THREE from "three";
import { apartOf } from "@/map/robots/robots";
import { poseAt } from "../frames";
import type { Palette } from "../palette";
import { ROBOT_SCALE } from "./scale";
import type { CopyOf, Moment, SceneDevice, SceneRecording } from "../types";

interface RobotCopyProps {
  device: SceneDevice;
  recording: SceneRecording;
  moment: Moment;
  palette: Palette;
  copyOf: CopyOf;
}

/** Where the simulated copy of a robot is, while it is not where the robot is: a body that one sees through. */
export function RobotCopy({ device, recording, moment, palette, copyOf }: RobotCopyProps) {
  const body = useRef<THREE.Group>(null);
  const radius = device.radius_m;
  useFrame(() => {
    if (!body.current) return;
    const [copy, pose] = [copyOf(device.id), poseAt(recording.frames, device.id, moment.t_s)];
    const apart = copy && pose ? apartOf(copy, { x: pose[0], y: pose[1] }) : null;
    body.current.visible = apart !== null;
    if (copy) body.current.position.set(copy.x, 0, -copy.y);
  });
  return (
    <group ref={body} visible={false} name={`copy-${device.id}`} scale={ROBOT_SCALE}>
      <mesh position={[0, 0.2, 0]}>
        <cylinderGeometry args={[radius * 0.9, radius, 0.36, 28]} />
        <meshStandardMaterial color={palette.motion} transparent opacity={0.3} depthWrite={false} />
      </mesh>
      <mesh position={[0, 0.03, 0]} rotation={[-Math.PI / 2, 0, 0]}>
        <ringGeometry args={[radius * 1.15, radius * 1.35, 36]} />
        <meshBasicMaterial color={palette.motion} />
      </mesh>
    </group>
  );
}
