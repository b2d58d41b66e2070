import { Html } from "@react-three/drei";
import type { RefObject } from "react";
import { drawnAt, type Incident, isNow } from "./incidents";
import type { Palette } from "./palette";
import styles from "./Scene3D.module.css";

const HEIGHT_M = 0.9;

interface IncidentsProps {
  incidents: readonly Incident[];
  t_s: number;
  palette: Palette;
  /** Where their numbers are put. */
  layer: RefObject<HTMLDivElement>;
  onJump: (t_s: number) => void;
}

/** Who touched, came too near or waited, where it was: a ring on the floor and its number; a press goes to its moment. */
export function Incidents({ incidents, t_s, palette, layer, onJump }: IncidentsProps) {
  return drawnAt(incidents, t_s).map((incident) => {
    const { at, number, kind } = incident;
    if (!at) return null;
    const now = isNow(incident, t_s);
    const color = kind === "collision" ? palette.error : palette.warnFill;
    return (
      <group key={number} position={[at[0], 0, -at[1]]} onClick={() => onJump(incident.t_s)}>
        <mesh rotation={[-Math.PI / 2, 0, 0]} position={[0, 0.05, 0]}>
          <ringGeometry args={now ? [0.5, 0.75, 40] : [0.34, 0.46, 32]} />
          <meshBasicMaterial color={color} transparent opacity={now ? 0.95 : 0.7} />
        </mesh>
        <mesh position={[0, HEIGHT_M / 2, 0]}>
          <cylinderGeometry args={[0.02, 0.02, HEIGHT_M, 6]} />
          <meshBasicMaterial color={color} />
        </mesh>
        <Html
          portal={layer}
          position={[0, HEIGHT_M, 0]}
          center
          zIndexRange={now ? [40, 30] : [15, 0]}
          wrapperClass={styles.anchor}
        >
          <span className={styles.pin} data-kind={kind} data-now={now || undefined}>
            {number}
          </span>
        </Html>
      </group>
    );
  });
}
