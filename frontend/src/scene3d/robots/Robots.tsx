/** All robots of a place, each part of them drawn by one call however many there are. */
import { useFrame } from "@react-three/fiber";
import { memo, type RefObject, useEffect, useMemo, useRef } from "react";
import * as THREE from "three";
import { byLook } from "../alike";
import { poseAt } from "../frames";
import type { CopyOf, SceneDevice, SceneRecording } from "../types";
import { type LoadShape, loadAt } from "./loads";
import { PlannedPaths, Trails } from "./Paths";
import type { RobotsProps } from "./props";
import { RobotCopy } from "./RobotCopy";
import { ROBOT_SCALE } from "./scale";
import { boxGeometry, canGeometry, frontGeometry, shadowGeometry, turtleGeometry } from "./turtle";

interface AllProps extends RobotsProps {
  playing: boolean;
  /** The one from whose place the view is. */
  hidden: string | null;
  copyOf?: CopyOf;
}

/** A geometry for as long as it is shown. */
function useGeometry(make: () => THREE.BufferGeometry, needs: unknown[]): THREE.BufferGeometry {
  // oxlint-disable-next-line react/exhaustive-deps -- who calls says what it is made of
  const geometry = useMemo(make, needs);
  useEffect(() => () => geometry.dispose(), [geometry]);
  return geometry;
}

const UP = new THREE.Vector3(0, 1, 0);
const SCALE = new THREE.Vector3(ROBOT_SCALE, ROBOT_SCALE, ROBOT_SCALE);

/** Where a robot stands at a moment, as the scene has it: where it was told to be when nothing was recorded. */
function place(into: THREE.Matrix4, recording: SceneRecording, robot: SceneDevice, t_s: number): void {
  const { x: atX, y: atY } = robot.location;
  const [x, y, theta] = poseAt(recording.frames, robot.id, t_s) ?? [atX, atY, robot.location.theta];
  into.compose(new THREE.Vector3(x, 0, -y), new THREE.Quaternion().setFromAxisAngle(UP, theta), SCALE);
}

function show(mesh: THREE.InstancedMesh | null, matrices: readonly THREE.Matrix4[]): void {
  if (!mesh) return;
  matrices.forEach((matrix, index) => mesh.setMatrixAt(index, matrix));
  mesh.count = matrices.length;
  mesh.instanceMatrix.needsUpdate = true;
}

interface FleetProps extends RobotsProps {
  radius: number;
  hidden: string | null;
}

/** Robots of one size with what they carry. */
function Fleet({ robots, recording, moment, palette, radius, hidden }: FleetProps) {
  const [body, front, shadow] = [useMesh(), useMesh(), useMesh()];
  const loads: Record<LoadShape, RefObject<THREE.InstancedMesh | null>> = { box: useMesh(), can: useMesh() };
  const matrices = useMemo(() => robots.map(() => new THREE.Matrix4()), [robots]);
  useFrame(() => {
    const seen: THREE.Matrix4[] = [];
    const carrying: Record<LoadShape, THREE.Matrix4[]> = { box: [], can: [] };
    robots.forEach((robot, index) => {
      const matrix = matrices[index];
      if (!matrix || robot.id === hidden) return;
      place(matrix, recording, robot, moment.t_s);
      seen.push(matrix);
      const load = loadAt(recording, robot.id, moment.t_s);
      if (load) carrying[load].push(matrix);
    });
    for (const part of [body, front, shadow]) show(part.current, seen);
    for (const shape of ["box", "can"] as const) show(loads[shape].current, carrying[shape]);
  });
  const turtle = useGeometry(() => turtleGeometry(radius, palette), [radius, palette]);
  const sign = useGeometry(() => frontGeometry(radius), [radius]);
  const blot = useGeometry(() => shadowGeometry(radius), [radius]);
  const box = useGeometry(() => boxGeometry(palette), [palette]);
  const can = useGeometry(() => canGeometry(palette), [palette]);
  const most = robots.length;
  return (
    <>
      <instancedMesh ref={body} args={[turtle, undefined, most]} frustumCulled={false}>
        <meshLambertMaterial vertexColors />
      </instancedMesh>
      <instancedMesh ref={front} args={[sign, undefined, most]} frustumCulled={false}>
        <meshLambertMaterial color={palette.motion} emissive={palette.motion} emissiveIntensity={0.6} />
      </instancedMesh>
      <instancedMesh ref={shadow} args={[blot, undefined, most]} frustumCulled={false}>
        <meshBasicMaterial color="#000000" transparent opacity={palette.dark ? 0.4 : 0.2} depthWrite={false} />
      </instancedMesh>
      <instancedMesh ref={loads.box} args={[box, undefined, most]} frustumCulled={false}>
        <meshLambertMaterial vertexColors />
      </instancedMesh>
      <instancedMesh ref={loads.can} args={[can, undefined, most]} frustumCulled={false}>
        <meshLambertMaterial vertexColors />
      </instancedMesh>
    </>
  );
}

const useMesh = () => useRef<THREE.InstancedMesh>(null);

/** The robots where the recording has them, with their loads, their trails and their paths. */
export const Robots = memo(function Robots({ copyOf, hidden, playing, ...props }: AllProps) {
  const fleets = useMemo(() => byLook(props.robots, (robot) => String(robot.radius_m)), [props.robots]);
  return (
    <>
      {fleets.map(([look, robots]) => (
        <Fleet key={`${look} ${robots.length}`} {...props} robots={robots} radius={Number(look)} hidden={hidden} />
      ))}
      <Trails {...props} playing={playing} />
      <PlannedPaths {...props} />
      {copyOf
        ? props.robots.map((device) => <RobotCopy key={device.id} {...props} device={device} copyOf={copyOf} />)
        : null}
    </>
  );
});
