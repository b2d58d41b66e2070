/** What the robot's lidar would see at the moment: drawn each time that the moment is another. */
import { useEffect, useMemo, useRef } from "react";
import { useTranslation } from "react-i18next";
import { type Frames, poseAt } from "@/scene3d/frames";
import { outlinesOf, RANGE_M, RAYS, scan } from "./rays";
import styles from "./Lidar.module.css";
import { FrameLoop } from "@/map/plane/frameLoop";
import type { Moment, SceneDevice, SceneMap } from "@/scene3d/types";

const SIDE = 168;

interface LidarProps {
  map: SceneMap;
  devices: readonly SceneDevice[];
  frames: Frames;
  robot: SceneDevice;
  moment: Moment;
}

export function Lidar({ map, devices, frames, robot, moment }: LidarProps) {
  const { t } = useTranslation();
  const canvas = useRef<HTMLCanvasElement>(null);
  const outlines = useMemo(() => outlinesOf(devices.filter(({ kind }) => kind === "machine")), [devices]);
  const others = useMemo(
    () => devices.filter(({ kind, id }) => kind === "robot" && id !== robot.id),
    [devices, robot.id],
  );
  useEffect(() => {
    let shown = -1;
    const loop = new FrameLoop(() => {
      const context = canvas.current?.getContext("2d");
      if (!context || moment.t_s === shown) return false;
      shown = moment.t_s;
      const pose = poseAt(frames, robot.id, shown);
      const rounds = others.flatMap(({ id, radius_m }) => {
        const at = poseAt(frames, id, shown);
        return at ? [{ x: at[0], y: at[1], radius_m }] : [];
      });
      draw(context, pose ? scan(map, pose, outlines, rounds) : []);
      return true;
    });
    return () => loop.stop();
  }, [map, frames, robot.id, moment, outlines, others]);
  return (
    <figure className={styles.lidar}>
      <canvas
        ref={canvas}
        width={SIDE * 2}
        height={SIDE * 2}
        role="img"
        aria-label={t("simulation.lidarOf", { name: robot.name })}
      />
      <figcaption>
        <b>{t("simulation.lidar")}</b> {robot.name}
        <small>{t("simulation.lidarNote", { range: RANGE_M })}</small>
      </figcaption>
    </figure>
  );
}

/** Up is where the robot looks. */
function draw(context: CanvasRenderingContext2D, distances: readonly number[]): void {
  const style = getComputedStyle(context.canvas);
  const colour = (token: string) => style.getPropertyValue(`--${token}`).trim();
  const { width } = context.canvas;
  const [middle, metre] = [width / 2, width / 2 / (RANGE_M + 0.4)];
  context.clearRect(0, 0, width, width);
  context.strokeStyle = colour("line-2");
  context.lineWidth = 1.5;
  for (let ring_m = 2; ring_m <= RANGE_M; ring_m += 2) {
    context.beginPath();
    context.arc(middle, middle, ring_m * metre, 0, 2 * Math.PI);
    context.stroke();
  }
  const end = (far: number, ray: number) => {
    const angle = -Math.PI / 2 - (ray / RAYS) * 2 * Math.PI;
    const reach = Math.min(far, RANGE_M) * metre;
    return [middle + Math.cos(angle) * reach, middle + Math.sin(angle) * reach] as const;
  };
  context.beginPath();
  distances.forEach((far, ray) => context.lineTo(...end(far, ray)));
  context.closePath();
  context.fillStyle = colour("busy-soft");
  context.fill();
  context.fillStyle = colour("busy");
  distances.forEach((far, ray) => {
    const [x, y] = end(far, ray);
    if (Number.isFinite(far)) context.fillRect(x - 2, y - 2, 4, 4);
  });
  context.fillStyle = colour("text");
  context.beginPath();
  context.moveTo(middle, middle - 12);
  context.lineTo(middle + 8, middle + 9);
  context.lineTo(middle - 8, middle + 9);
  context.fill();
}
