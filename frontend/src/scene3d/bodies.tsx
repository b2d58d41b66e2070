import type { ComponentType } from "react";
import type { Palette } from "./palette";
import type { SceneDevice } from "./types";

interface BodyProps {
  size: SceneDevice["size"];
  palette: Palette;
}

interface BoxProps {
  at: [number, number, number];
  size: [number, number, number];
  color: string;
  glow?: number;
}

function Box({ at, size, color, glow = 0 }: BoxProps) {
  return (
    <mesh position={at} castShadow receiveShadow>
      <boxGeometry args={size} />
      <meshStandardMaterial color={color} emissive={color} emissiveIntensity={glow} roughness={0.7} />
    </mesh>
  );
}

function Can({
  at,
  radius,
  height,
  color,
}: {
  at: [number, number, number];
  radius: number;
  height: number;
  color: string;
}) {
  return (
    <mesh position={at} castShadow receiveShadow>
      <cylinderGeometry args={[radius, radius, height, 24]} />
      <meshStandardMaterial color={color} roughness={0.5} metalness={0.2} />
    </mesh>
  );
}

/** Evenly spaced positions along a length, centred. */
const spread = (count: number, length: number) =>
  Array.from({ length: count }, (_, index) => (index + 0.5) * (length / count) - length / 2);

function Shelf({ size, palette }: BodyProps) {
  return (
    <group>
      {[0.06, 0.5, 0.94].map((y) => (
        <Box key={y} at={[0, y, 0]} size={[size.x, 0.06, size.y]} color={palette.bodyDark} />
      ))}
      {[0.27, 0.71, 1.15].flatMap((y) =>
        spread(4, size.x).flatMap((x) =>
          spread(2, size.y).map((z) => (
            <Box
              key={`${x}${y}${z}`}
              at={[x, y, z]}
              size={[size.x / 4.6, 0.34, size.y / 2.6]}
              color={palette.warnFill}
            />
          )),
        ),
      )}
    </group>
  );
}

function Cans({ size, palette }: BodyProps) {
  const colors = [palette.machine, palette.error, palette.warnFill, palette.motion, palette.done];
  return (
    <group>
      {[0.06, 0.5].map((y) => (
        <Box key={y} at={[0, y, 0]} size={[size.x, 0.06, size.y]} color={palette.bodyDark} />
      ))}
      {[0.27, 0.71].flatMap((y, level) =>
        spread(6, size.x).flatMap((x, column) =>
          spread(2, size.y).map((z, row) => (
            <Can
              key={`${x}${y}${z}`}
              at={[x, y, z]}
              radius={0.15}
              height={0.34}
              color={colors[(column + row * 2 + level) % 5] ?? palette.machine}
            />
          )),
        ),
      )}
    </group>
  );
}

function Mixer({ size, palette }: BodyProps) {
  return (
    <group>
      <Box at={[0, 0.1, 0]} size={[size.x, 0.2, size.y]} color={palette.bodyDark} />
      <Can at={[0, 0.62, 0]} radius={size.x * 0.34} height={0.85} color={palette.body} />
      <Can at={[0, 1.1, 0]} radius={size.x * 0.24} height={0.12} color={palette.bodyDark} />
      <Can at={[0, 1.3, 0]} radius={0.09} height={0.3} color={palette.machine} />
    </group>
  );
}

function Booth({ size, palette }: BodyProps) {
  return (
    <group>
      <Box at={[0, 0.22, size.y * 0.2]} size={[size.x, 0.12, size.y * 0.6]} color={palette.bodyDark} />
      {spread(8, size.x).map((x) => (
        <Box key={x} at={[x, 0.3, size.y * 0.2]} size={[0.1, 0.06, size.y * 0.55]} color={palette.body} />
      ))}
      <Box at={[0, 0.75, -size.y * 0.18]} size={[size.x * 0.86, 1.5, size.y * 0.6]} color={palette.body} />
      <Box at={[0, 0.7, size.y * 0.125]} size={[size.x * 0.6, 0.62, 0.03]} color={palette.motion} glow={0.35} />
    </group>
  );
}

function Oven({ size, palette }: BodyProps) {
  return (
    <group>
      <Box at={[0, 0.7, 0]} size={[size.x, 1.4, size.y]} color={palette.body} />
      <Box
        at={[-size.x * 0.12, 0.55, size.y / 2 + 0.01]}
        size={[size.x * 0.5, 0.5, 0.04]}
        color={palette.warnFill}
        glow={0.8}
      />
      <Box
        at={[size.x * 0.32, 0.85, size.y / 2 + 0.01]}
        size={[size.x * 0.16, 0.24, 0.04]}
        color={palette.busy}
        glow={0.6}
      />
      <Box at={[-size.x * 0.2, 1.46, 0]} size={[size.x * 0.35, 0.12, size.y * 0.5]} color={palette.bodyDark} />
      <Can at={[size.x * 0.3, 1.6, 0]} radius={0.14} height={0.5} color={palette.bodyDark} />
    </group>
  );
}

function Rollers({ size, palette }: BodyProps) {
  return (
    <group>
      <Box at={[0, 0.3, 0]} size={[size.x, 0.14, size.y]} color={palette.bodyDark} />
      {spread(9, size.x).map((x) => (
        <mesh key={x} position={[x, 0.4, 0]} rotation={[Math.PI / 2, 0, 0]} castShadow>
          <cylinderGeometry args={[0.07, 0.07, size.y * 0.94, 12]} />
          <meshStandardMaterial color={palette.body} roughness={0.4} metalness={0.3} />
        </mesh>
      ))}
    </group>
  );
}

function Plain({ size, palette }: BodyProps) {
  const height = Math.max(size.z, 0.4);
  return <Box at={[0, height / 2, 0]} size={[size.x, height, size.y]} color={palette.body} />;
}

const BODIES: Record<string, ComponentType<BodyProps>> = {
  shelf: Shelf,
  cans: Cans,
  mixer: Mixer,
  booth: Booth,
  oven: Oven,
  rollers: Rollers,
};

/** The body of a class of machine; a class without a model gets a box of its size. */
export function bodyFor(deviceClass: string): ComponentType<BodyProps> {
  return BODIES[deviceClass] ?? Plain;
}
