import type { MapObstacle } from "@/map/floor/floor";
import type { Palette } from "./palette";

const HEIGHT_M = 0.7;
const STRIPE_M = 0.12;

/** What lies in the way of simulated robots: a barrel with a light stripe, as on a building site. */
export function Obstacles({ obstacles, palette }: { obstacles: readonly MapObstacle[]; palette: Palette }) {
  return obstacles.map(({ x, y, size_m }, index) => (
    <group key={index} position={[x, HEIGHT_M / 2, -y]}>
      <mesh castShadow receiveShadow>
        <cylinderGeometry args={[size_m / 2, size_m / 2, HEIGHT_M, 24]} />
        <meshStandardMaterial color={palette.warnFill} roughness={0.7} />
      </mesh>
      <mesh>
        <cylinderGeometry args={[size_m / 2 + 0.005, size_m / 2 + 0.005, STRIPE_M, 24]} />
        <meshStandardMaterial color="#ffffff" roughness={0.6} />
      </mesh>
    </group>
  ));
}
