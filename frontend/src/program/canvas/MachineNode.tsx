/** A machine on the map: its outline with the ring, its name and how it is. */
import { memo, type CSSProperties } from "react";
import { activityWords } from "@/i18n/activity";
import { statusOf } from "@/map/devices/device";
import { DeviceToken } from "@/map/devices/DeviceToken";
import type { LevelOfDetail } from "../scene/detail";
import type { SiteDevice } from "../surroundings";
import classes from "./stage.module.css";

/** How a machine looks while a tool asks for one. */
export type Light = "suitable" | "dim" | "chosen" | null;

export interface MachineNodeProps {
  device: SiteDevice;
  light: Light;
  /** "Pick from" over the source that was clicked. */
  caption: string | null;
  /** Names stand where no chip covers them. */
  side: "above" | "below" | "right" | "left";
  /** Further away than usual, drawing pixels. */
  gap: number;
  detail: LevelOfDetail;
}

export const MachineNode = memo(function MachineNode(props: MachineNodeProps) {
  const { device, light, caption, side, gap, detail } = props;
  return (
    <div
      className={classes.machine}
      data-light={light ?? undefined}
      data-side={side}
      data-lod={detail}
      style={{ "--label-gap": `${gap}px` } as CSSProperties}
    >
      <DeviceToken device={device} />
      {light === "suitable" || light === "chosen" ? <span className={classes.halo} aria-hidden="true" /> : null}
      {caption ? <span className={classes.caption}>{caption}</span> : null}
      <span className={classes.label}>
        <strong>{device.name}</strong>
        <span data-status={statusOf(device)}>{activityWords(device)}</span>
      </span>
    </div>
  );
});
