import { OrbitControls, PerformanceMonitor } from "@react-three/drei";
import { Canvas, useFrame, useThree } from "@react-three/fiber";
import { memo, type RefObject, useEffect, useMemo, useRef, useState } from "react";
import * as THREE from "three";
import type { OrbitControls as Controls } from "three-stdlib";
import type { MapObstacle } from "@/map/floor/floor";
import { poseAt } from "./frames";
import type { Incident } from "./incidents";
import { Building } from "./Building";
import { distanceFor } from "./camera";
import { Incidents } from "./Incidents";
import { bodyOf, surroundingsOf } from "./machines/bodies";
import { Lamps } from "./machines/Lamps";
import { Machines } from "./machines/Machines";
import { NamePlaces, NameTags } from "./names/Names";
import { Obstacles } from "./Obstacles";
import { type Palette, readPalette } from "./palette";
import { Robots } from "./robots/Robots";
import { prismOfObstacle, prismsOf, SUN } from "./shadows";
import styles from "./Scene3D.module.css";
import type { CameraMode, CopyOf, Moment, SceneDevice, SceneMap, SceneRecording } from "./types";
import { useArea } from "./useArea";

interface SceneProps {
  map: SceneMap;
  devices: readonly SceneDevice[];
  recording: SceneRecording | null;
  moment: Moment;
  camera: CameraMode;
  follow: string | null;
  labels: boolean;
  label: string;
  /** While it plays each picture is drawn; else only when something changes. */
  playing: boolean;
  /** All pictures are to be as large. */
  filming?: boolean;
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

function CameraRig({ map, recording, moment, camera: mode, follow }: SceneProps) {
  const camera = useThree((state) => state.camera) as THREE.PerspectiveCamera;
  const aspect = useThree((state) => state.size.width / Math.max(1, state.size.height));
  const controls = useRef<Controls>(null);
  const area = useArea(map);
  useEffect(() => {
    camera.fov = mode === "robot" ? ROBOT_CAMERA.field : FIELD_OF_VIEW;
    camera.updateProjectionMatrix();
    if (mode === "robot") return;
    const from = mode === "top" ? new THREE.Vector3(0, 1, 0.001) : new THREE.Vector3(-0.22, 0.72, 0.66);
    const distance = mode === "follow" ? 7 : distanceFor(area.width, area.depth, from, camera.fov, aspect);
    camera.position.copy(area.centre).addScaledVector(from.normalize(), distance);
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
      maxDistance={Math.max(120, area.width + area.depth)}
    />
  );
}

/** Draws one more picture, and another for what follows from it, when `on` changes. */
function Redraw({ on }: { on: number }) {
  const invalidate = useThree((state) => state.invalidate);
  useEffect(() => invalidate(2), [invalidate, on]);
  return null;
}

function Lights({ palette }: { palette: Palette }) {
  return (
    <>
      <hemisphereLight args={["#ffffff", palette.dark ? "#222a3a" : "#c8d0de", palette.dark ? 1.9 : 1.7]} />
      <directionalLight position={SUN} intensity={palette.dark ? 1.7 : 1.6} />
    </>
  );
}

type StandingProps = Pick<SceneProps, "map" | "recording" | "moment"> & {
  machines: readonly SceneDevice[];
  palette: Palette;
};

/** All that stays where it is, drawn anew by React only when it is another. */
const Standing = memo(function Standing({ map, machines, palette, recording, moment }: StandingProps) {
  const obstacles = map.obstacles ?? NO_OBSTACLES;
  const standing = useMemo(() => {
    const bodies = machines.flatMap((device) => {
      const { solids, glowing } = bodyOf(device.device_class, device.size, palette);
      return prismsOf(device, [...solids, ...glowing, ...surroundingsOf(device.size, palette)]);
    });
    return [...bodies, ...obstacles.map(prismOfObstacle)];
  }, [machines, obstacles, palette]);
  return (
    <>
      <Lights palette={palette} />
      <Building map={map} palette={palette} standing={standing} />
      <Obstacles obstacles={obstacles} palette={palette} />
      <Machines machines={machines} palette={palette} />
      <Lamps {...{ machines, recording, moment, palette }} />
    </>
  );
});

const SHARPEST = 2;
const BLUNTEST = 0.4;
/** Pictures a second: with fewer it is drawn with fewer pixels, with more again with more. */
const SMOOTH: [number, number] = [29, 50];

/** Pixels for each of the page's: as many as the screen has, fewer while it plays on a machine that cannot keep up. */
function useSharpness(adapts: boolean) {
  const [part, setPart] = useState(1);
  const most = Math.min(Math.max(window.devicePixelRatio, 1), SHARPEST);
  const monitor = adapts ? (
    <PerformanceMonitor
      factor={part}
      iterations={4}
      step={0.25}
      bounds={() => SMOOTH}
      flipflops={12}
      onChange={({ factor }) => setPart(factor)}
    />
  ) : null;
  return { dpr: adapts ? most * (BLUNTEST + (1 - BLUNTEST) * part) : most, monitor };
}

/** Smooth edges cost a third of a picture where the processor draws it, and are not seen where pixels are small. */
function smoothsEdges(): boolean {
  const canvas = document.createElement("canvas");
  const tried = canvas.getContext("webgl2", { failIfMajorPerformanceCaveat: true });
  tried?.getExtension("WEBGL_lose_context")?.loseContext(); // a browser has few of them
  return window.devicePixelRatio < 2 && tried !== null;
}

/** The whole scene: the place built from its map, its machines, and the robots at the moment that is shown. */
export function Scene3D(props: SceneProps) {
  const { map, devices, recording, moment, labels, label, stateOf, copyOf, playing, t_s } = props;
  const palette = usePalette();
  const [antialias] = useState(smoothsEdges);
  const { dpr, monitor } = useSharpness(playing && !props.filming);
  const names = useRef<HTMLDivElement>(null);
  const pins = useRef<HTMLDivElement>(null) as RefObject<HTMLDivElement>;
  const machines = useMemo(() => devices.filter((device) => device.kind === "machine"), [devices]);
  const robots = useMemo(() => devices.filter((device) => device.kind === "robot"), [devices]);
  const named = useMemo(() => (recording ? [...robots, ...machines] : machines), [recording, robots, machines]);
  return (
    <>
      <Canvas
        className={styles.canvas}
        frameloop={playing ? "always" : "demand"}
        gl={{ antialias }}
        dpr={dpr}
        camera={{ fov: FIELD_OF_VIEW, near: 0.1, far: 2000 }}
        aria-label={label}
        role="img"
      >
        {monitor}
        <Redraw on={t_s} />
        <CameraRig {...props} />
        <Standing {...{ map, machines, palette, recording, moment }} />
        {recording && (
          <Robots
            {...{ robots, recording, moment, palette, playing, copyOf }}
            hidden={props.camera === "robot" ? props.follow : null}
          />
        )}
        <Incidents
          incidents={props.incidents ?? NONE}
          t_s={t_s}
          palette={palette}
          layer={pins}
          onJump={(at_s) => props.onJump?.(at_s)}
        />
        {labels && <NamePlaces {...{ devices: named, recording, moment, layer: names }} />}
      </Canvas>
      <div ref={names} className={styles.names} aria-hidden="true">
        {labels && <NameTags devices={named} stateOf={stateOf} />}
      </div>
      <div ref={pins} className={styles.names} aria-hidden="true" />
    </>
  );
}
