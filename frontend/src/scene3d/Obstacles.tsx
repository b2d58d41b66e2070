import type { MapObstacle } from "@/map/floor/floor";
import type { Palette } from "./palette";
import { OBSTACLE_HEIGHT_M } from "./shadows";

const STRIPE_M = 0.12;

/** What lies in the way of simulated robots: a barrel with a light stripe, as on a building site. */
export function Obstacles({ obstacles, palette }: { obstacles: readonly MapObstacle[]; palette: Palette }) {
  return obstacles.map(({ x, y, size_m }, index) => (
    <group key={index} position={[x, OBSTACLE_HEIGHT_M / 2, -y]}>
      <mesh>
        <cylinderGeometry args={[size_m / 2, size_m / 2, OBSTACLE_HEIGHT_M, 24]} />
        <meshLambertMaterial color={palette.warnFill} />
      </mesh>
      <mesh>
        <cylinderGeometry args={[size_m / 2 + 0.005, size_m / 2 + 0.005, STRIPE_M, 24]} />
        <meshLambertMaterial color="#ffffff" />
      </mesh>
    </group>
  ));
}
