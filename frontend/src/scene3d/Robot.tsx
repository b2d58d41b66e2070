import { Line } from "@react-three/drei";
import { useFrame } from "@react-three/fiber";
import { useMemo, useRef, useState } from "react";
import type * as THREE from "three";
import { latest, poseAt, trailBefore } from "./frames";
import type { Palette } from "./palette";
import { RobotCopy } from "./RobotCopy";
import { ROBOT_SCALE } from "./scale";
import type { CopyOf, Moment, SceneDevice, SceneRecording } from "./types";

const TRAIL_S = 30;
const NOWHERE: readonly (readonly [number, number])[] = [];

interface RobotProps {
  device: SceneDevice;
  recording: SceneRecording;
  moment: Moment;
  palette: Palette;
}

interface OwnProps extends RobotProps {
  /** The view is from its own place. */
  hidden?: boolean;
  copyOf?: CopyOf;
}

function Turtle({ radius, palette }: { radius: number; palette: Palette }) {
  const decks = [0.06, 0.2, 0.34];
  return (
    <group>
      {decks.map((y, index) => (
        <mesh key={y} position={[0, y, 0]} castShadow>
          <cylinderGeometry args={[radius * (1 - index * 0.08), radius * (1 - index * 0.08), 0.05, 28]} />
          <meshStandardMaterial color={index === 0 ? palette.bodyDark : palette.body} roughness={0.6} />
        </mesh>
      ))}
      {[0.7, 2.4, 3.9, 5.5].map((angle) => (
        <mesh key={angle} position={[Math.cos(angle) * radius * 0.7, 0.2, Math.sin(angle) * radius * 0.7]}>
          <cylinderGeometry args={[0.012, 0.012, 0.32, 6]} />
          <meshStandardMaterial color={palette.bodyDark} />
        </mesh>
      ))}
      <mesh position={[radius * 0.75, 0.38, 0]}>
        <boxGeometry args={[radius * 0.3, 0.04, radius * 0.3]} />
        <meshStandardMaterial color={palette.motion} emissive={palette.motion} emissiveIntensity={0.6} />
      </mesh>
    </group>
  );
}

/** What the robot carries at the moment, as text such as `box`, drawn anew only when it changes. */
function useLoad(recording: SceneRecording, robot: string, moment: Moment): string {
  const [load, setLoad] = useState("");
  useFrame(() => {
    const carried = latest(recording.carrying[robot], moment.t_s)?.[1] ?? {};
    const now = Object.entries(carried)
      .filter(([, count]) => count > 0)
      .map(([object]) => object)
      .join(",");
    if (now !== load) setLoad(now);
  });
  return load;
}

function Load({ kind, palette }: { kind: string; palette: Palette }) {
  if (!kind) return null;
  return (
    <mesh position={[0, 0.5, 0]} castShadow>
      {kind.includes("can") ? (
        <cylinderGeometry args={[0.1, 0.1, 0.24, 20]} />
      ) : (
        <boxGeometry args={[0.24, 0.22, 0.24]} />
      )}
      <meshStandardMaterial color={kind.includes("can") ? palette.machine : palette.warnFill} roughness={0.6} />
    </mesh>
  );
}

/** The last half minute of a robot's path, renewed four times a second of the recording. */
function Trail({ device, recording, moment, palette }: RobotProps) {
  const [points, setPoints] = useState<[number, number][]>([]);
  const shown = useRef(-1);
  useFrame(() => {
    const step = Math.floor(moment.t_s * 4);
    if (step === shown.current) return;
    shown.current = step;
    setPoints(trailBefore(recording.frames, device.id, moment.t_s, TRAIL_S));
  });
  const line = useMemo(() => points.map(([x, y]) => [x, 0.04, -y] as [number, number, number]), [points]);
  return line.length > 1 ? <Line points={line} color={palette.busy} lineWidth={5} transparent opacity={0.75} /> : null;
}

/** The path that the robot is on at the moment. */
function PlannedPath({ device, recording, moment, palette }: RobotProps) {
  const [path, setPath] = useState(NOWHERE);
  useFrame(() => {
    const now = latest(recording.routes[device.id], moment.t_s)?.[1] ?? NOWHERE;
    if (now !== path) setPath(now);
  });
  const line = path.map(([x, y]) => [x, 0.03, -y] as [number, number, number]);
  return line.length > 1 ? (
    <Line points={line} color={palette.motion} lineWidth={2.5} dashed dashSize={0.25} gapSize={0.18} />
  ) : null;
}

/** A robot where the recording has it, with its load, its trail and its path. */
export function Robot(props: OwnProps) {
  const { device, recording, moment, palette, copyOf, hidden = false } = props;
  const body = useRef<THREE.Group>(null);
  const load = useLoad(recording, device.id, moment);
  useFrame(() => {
    const pose = poseAt(recording.frames, device.id, moment.t_s);
    if (!pose || !body.current) return;
    body.current.position.set(pose[0], 0, -pose[1]);
    body.current.rotation.set(0, pose[2], 0);
  });
  const [x, y, theta] = poseAt(recording.frames, device.id, moment.t_s) ?? [device.location.x, device.location.y, 0];
  return (
    <>
      <group ref={body} visible={!hidden} name={`robot-${device.id}`} position={[x, 0, -y]} rotation={[0, theta, 0]}>
        <group scale={ROBOT_SCALE}>
          <Turtle radius={device.radius_m || 0.18} palette={palette} />
          <Load kind={load} palette={palette} />
        </group>
      </group>
      <Trail {...props} />
      <PlannedPath {...props} />
      {copyOf ? <RobotCopy {...props} copyOf={copyOf} /> : null}
    </>
  );
}
