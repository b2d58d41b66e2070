/** The icon of a device's class: VIPO's own where there is one, Lucide's else. */
import { Boxes, Cpu, PackageCheck, PaintBucket, SprayCan, type LucideIcon } from "lucide-react";
import { hasVipoIcon, VipoIcon } from "@/design/VipoIcon";
import { ownEntry } from "@/design/ownEntry";

const LUCIDE: Readonly<Record<string, LucideIcon>> = {
  shelf: Boxes,
  cans: PaintBucket,
  booth: SprayCan,
  rollers: PackageCheck,
};

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
  if (hasVipoIcon(deviceClass)) return <VipoIcon name={deviceClass} size={size} x={x} y={y} />;
  const Icon = ownEntry(LUCIDE, deviceClass) ?? Cpu;
  return <Icon size={size} x={x} y={y} strokeWidth={size <= 15 ? 2 : 1.75} aria-hidden="true" />;
}
