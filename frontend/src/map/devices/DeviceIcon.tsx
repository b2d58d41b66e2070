/** The icon of a device's class: VIPO's own where there is one, Lucide's else. */
import { Boxes, Cpu, PackageCheck, PaintBucket, SprayCan, type LucideIcon } from "lucide-react";
import { hasVipoIcon, VipoIcon } from "@/design/VipoIcon";

const LUCIDE: Readonly<Record<string, LucideIcon>> = {
  shelf: Boxes,
  cans: PaintBucket,
  booth: SprayCan,
  rollers: PackageCheck,
};
/** Only classes whose file has another name. */
const OWN: Readonly<Record<string, string>> = { turtlebot: "turtle" };

export function DeviceIcon({
  deviceClass,
  size = 18,
  x,
  y,
}: {
  deviceClass: string;
  size?: number;
  x?: number;
  y?: number;
}) {
  const own = OWN[deviceClass] ?? deviceClass;
  if (!LUCIDE[deviceClass] && hasVipoIcon(own)) return <VipoIcon name={own} size={size} x={x} y={y} />;
  const Icon = LUCIDE[deviceClass] ?? Cpu;
  return <Icon size={size} x={x} y={y} strokeWidth={size <= 15 ? 2 : 1.75} aria-hidden="true" />;
}
