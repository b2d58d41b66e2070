import { Html, OrbitControls } from "@react-three/drei";
import { Canvas, useFrame, useThree } from "@react-three/fiber";
import { type RefObject, useEffect, useMemo, useRef, useState } from "react";
import * as THREE from "three";
import type { OrbitControls as Controls } from "three-stdlib";
import type { MapObstacle } from "@/map/floor/floor";
import { poseAt } from "./frames";
import type { Incident } from "./incidents";
import { Building } from "./Building";
import { Incidents } from "./Incidents";
import { Machine } from "./Machine";
import { Obstacles } from "./Obstacles";
import { type Palette, readPalette } from "./palette";
import { Robot } from "./Robot";
import styles from "./Scene3D.module.css";
import type { CameraMode, CopyOf, Moment, SceneDevice, SceneMap, SceneRecording } from "./types";

interface SceneProps {
  map: SceneMap;
  devices: SceneDevice[];
  recording: SceneRecording | null;
  moment: Moment;
  camera: CameraMode;
  follow: string | null;
  labels: boolean;
  label: string;
  /** While it plays each picture is drawn; else only when something changes. */
  playing: boolean;
  t_s: number;
  /** What is said of a device at the moment, beside its name. */
  stateOf?: (device: string) => string;
  /** Where the copies of robots are, asked for in each picture. */
  copyOf?: CopyOf;
  incidents?: readonly Incident[];
  onJump?: (t_s: number) => void;
}

const NONE: readonly Incident[] = [];
const NO_OBSTACLES: readonly MapObstacle[] = [];
const FIELD_OF_VIEW = 38;
/** A robot's camera looks over its own deck, which is drawn at twice its size. */
const ROBOT_CAMERA = { height_m: 0.95, ahead_m: 0.2, field: 62, looks_ahead_m: 4, looks_at_m: 0.55 };

/** The palette of the theme that is on, read anew when the theme changes. */
function usePalette(): Palette {
  const [palette, setPalette] = useState(readPalette);
  useEffect(() => {
    const observer = new MutationObserver(() => setPalette(readPalette()));
    observer.observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
    return () => observer.disconnect();
  }, []);
  return palette;
}

/** The known floor's middle and largest side, in metres. */
function extent(map: SceneMap) {
  const width = map.width * map.resolution_m;
  const depth = map.height * map.resolution_m;
  return { centre: new THREE.Vector3(map.origin.x + width / 2, 0, -(map.origin.y + depth / 2)), width, depth };
}

function CameraRig({ map, recording, moment, camera: mode, follow }: SceneProps) {
  const camera = useThree((state) => state.camera) as THREE.PerspectiveCamera;
  const aspect = useThree((state) => state.size.width / Math.max(1, state.size.height));
  const controls = useRef<Controls>(null);
  const area = useMemo(() => extent(map), [map]);
  useEffect(() => {
    camera.fov = mode === "robot" ? ROBOT_CAMERA.field : FIELD_OF_VIEW;
    camera.updateProjectionMatrix();
    if (mode === "robot") return;
    const half = Math.tan(((camera.fov / 2) * Math.PI) / 180);
    const distance = Math.max((area.width * 0.56) / (half * aspect), (area.depth * 0.7) / half);
    const direction = mode === "top" ? new THREE.Vector3(0, 1, 0.001) : new THREE.Vector3(-0.22, 0.72, 0.66);
    camera.position.copy(area.centre).addScaledVector(direction.normalize(), mode === "follow" ? 7 : distance);
    controls.current?.target.copy(area.centre);
    controls.current?.update();
  }, [camera, area, mode, aspect]);
  useFrame(() => {
    const pose = mode === "robot" && recording && follow ? poseAt(recording.frames, follow, moment.t_s) : null;
    if (!pose) return;
    const [x, y, theta] = pose;
    const ahead = (far_m: number, height_m: number) =>
      new THREE.Vector3(x + Math.cos(theta) * far_m, height_m, -(y + Math.sin(theta) * far_m));
    camera.position.copy(ahead(ROBOT_CAMERA.ahead_m, ROBOT_CAMERA.height_m));
    camera.lookAt(ahead(ROBOT_CAMERA.looks_ahead_m, ROBOT_CAMERA.looks_at_m));
  });
  useFrame(() => {
    const pose = mode === "follow" && recording && follow ? poseAt(recording.frames, follow, moment.t_s) : null;
    if (!pose || !controls.current) return;
    const target = new THREE.Vector3(pose[0], 0.4, -pose[1]);
    const shift = target.sub(controls.current.target);
    controls.current.target.add(shift);
    camera.position.add(shift);
    controls.current.update();
  });
  return (
    <OrbitControls
      ref={controls}
      enabled={mode !== "robot"}
      makeDefault
      maxPolarAngle={Math.PI / 2.1}
      minDistance={3}
      maxDistance={120}
    />
  );
}

/** Where names are put; without it drei moves them once the canvas is connected, and loses some on the way. */
type Layer = RefObject<HTMLDivElement>;

function Label({ device, state, layer }: { device: SceneDevice; state: string; layer: Layer }) {
  return (
    <Html
      portal={layer}
      position={[device.location.x, 1.9, -device.location.y]}
      center
      zIndexRange={[20, 0]}
      wrapperClass={styles.anchor}
    >
      <span className={styles.label}>
        <b>{device.name}</b> {state}
      </span>
    </Html>
  );
}

function RobotLabel({
  device,
  recording,
  moment,
  state,
  layer,
}: {
  device: SceneDevice;
  recording: SceneRecording;
  moment: Moment;
  state: string;
  layer: Layer;
}) {
  const group = useRef<THREE.Group>(null);
  useFrame(() => {
    const pose = poseAt(recording.frames, device.id, moment.t_s);
    if (pose) group.current?.position.set(pose[0], 1.5, -pose[1]);
  });
  const [x, y] = poseAt(recording.frames, device.id, moment.t_s) ?? [device.location.x, device.location.y];
  return (
    <group ref={group} position={[x, 1.5, -y]}>
      <Html portal={layer} center zIndexRange={[20, 0]} wrapperClass={styles.anchor}>
        <span className={styles.robotLabel}>
          <b>{device.name}</b> {state}
        </span>
      </Html>
    </group>
  );
}

/** Draws one more picture, and another for what follows from it, when `on` changes. */
function Redraw({ on }: { on: number }) {
  const invalidate = useThree((state) => state.invalidate);
  useEffect(() => invalidate(2), [invalidate, on]);
  return null;
}

function Lights({ palette, map }: { palette: Palette; map: SceneMap }) {
  const { centre, width } = extent(map);
  return (
    <>
      <hemisphereLight args={["#ffffff", palette.dark ? "#222a3a" : "#c8d0de", palette.dark ? 1.9 : 1.7]} />
      <directionalLight
        position={[centre.x - width * 0.3, width * 0.8, centre.z + width * 0.2]}
        intensity={palette.dark ? 1.7 : 1.6}
        castShadow
        shadow-mapSize={[2048, 2048]}
        shadow-camera-left={-width}
        shadow-camera-right={width}
        shadow-camera-top={width}
        shadow-camera-bottom={-width}
        shadow-camera-far={width * 3}
      />
    </>
  );
}

/** The whole scene: the place built from its map, its machines, and the robots at the moment that is shown. */
export function Scene3D(props: SceneProps) {
  const { map, devices, recording, moment, labels, label, stateOf, copyOf, playing, t_s } = props;
  const palette = usePalette();
  const layer = useRef<HTMLDivElement>(null) as Layer;
  const machines = devices.filter((device) => device.kind === "machine");
  const robots = devices.filter((device) => device.kind === "robot");
  return (
    <>
      <Canvas
        className={styles.canvas}
        shadows="percentage"
        frameloop={playing ? "always" : "demand"}
        dpr={[1, 2]}
        camera={{ fov: FIELD_OF_VIEW, near: 0.1, far: 400 }}
        aria-label={label}
        role="img"
      >
        <Lights palette={palette} map={map} />
        <Redraw on={t_s} />
        <CameraRig {...props} />
        <Building map={map} palette={palette} />
        <Obstacles obstacles={map.obstacles ?? NO_OBSTACLES} palette={palette} />
        {machines.map((device) => (
          <Machine key={device.id} device={device} recording={recording} moment={moment} palette={palette} />
        ))}
        {recording &&
          robots.map((device) => (
            <Robot
              hidden={props.camera === "robot" && props.follow === device.id}
              key={device.id}
              device={device}
              recording={recording}
              moment={moment}
              palette={palette}
              copyOf={copyOf}
            />
          ))}
        <Incidents
          incidents={props.incidents ?? NONE}
          t_s={t_s}
          palette={palette}
          layer={layer}
          onJump={(at_s) => props.onJump?.(at_s)}
        />
        {labels &&
          machines.map((device) => (
            <Label key={device.id} device={device} state={stateOf?.(device.id) ?? ""} layer={layer} />
          ))}
        {labels &&
          recording &&
          robots.map((device) => (
            <RobotLabel
              key={device.id}
              device={device}
              recording={recording}
              moment={moment}
              state={stateOf?.(device.id) ?? ""}
              layer={layer}
            />
          ))}
      </Canvas>
      <div ref={layer} className={styles.names} aria-hidden="true" />
    </>
  );
}
