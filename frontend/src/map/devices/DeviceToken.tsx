/** A device on the map: body, ring of its status, icon and badge; SVG with its middle at 0, 0. */
import { footprint, isRobot, progressOf, ringOf, statusOf, type DeviceStatus, type MapDevice } from "./device";
import { DeviceIcon } from "./DeviceIcon";
import classes from "../map.module.css";
import { MachineBody } from "./MachineBody";
import { StatusMark } from "./StatusMark";

const RADIUS = 19;

/** `<g>` for use inside an SVG. `plain` leaves out the ring's motion, for small still pictures. */
export function DeviceGlyph({ device, plain = false }: { device: MapDevice; plain?: boolean }) {
  const status = statusOf(device);
  const size = footprint(device);
  return (
    <g opacity={status === "offline" ? 0.72 : 1}>
      {isRobot(device) ? null : <MachineBody deviceClass={device.device_class} {...size} />}
      {isRobot(device) ? (
        <RobotBody theta={device.location.theta} />
      ) : (
        <circle r={RADIUS} fill="var(--panel)" stroke="var(--line-2)" strokeWidth={1} />
      )}
      <StatusRing status={status} progress={progressOf(device)} still={plain} />
      {isRobot(device) ? null : (
        <g color="var(--text)" opacity={status === "offline" ? 0.6 : 1}>
          <DeviceIcon deviceClass={device.device_class} size={20} x={-10} y={-10} />
        </g>
      )}
      <g transform={`translate(${RADIUS * 0.74} ${RADIUS * 0.74})`}>
        <StatusMark status={status} />
      </g>
    </g>
  );
}

function RobotBody({ theta }: { theta: number }) {
  return (
    <g transform={`rotate(${(-theta * 180) / Math.PI})`}>
      <circle r={15} fill="var(--panel)" stroke="var(--text-2)" strokeWidth={1.6} />
      <path d="M15.5 -5.5 22 0 15.5 5.5Z" fill="var(--text)" stroke="none" />
      <circle r={4.6} fill="none" stroke="var(--text)" strokeWidth={1.6} />
      <path d="M4.6 0H15M-2.6 4 -8 11.6M-2.6 -4 -8 -11.6" stroke="var(--text-2)" strokeWidth={1.4} fill="none" />
    </g>
  );
}

function StatusRing({ status, progress, still }: { status: DeviceStatus; progress: number | null; still: boolean }) {
  const ring = ringOf(status);
  const length = 2 * Math.PI * RADIUS;
  const arc = status === "busy" ? length * (progress ?? 0.3) : 0;
  return (
    <g fill="none" stroke={ring.colour} strokeLinecap={status === "pending" ? "round" : "butt"}>
      {status === "busy" ? (
        <>
          <circle r={RADIUS} stroke="var(--busy-soft)" strokeWidth={ring.width} />
          <circle
            r={RADIUS}
            strokeWidth={ring.width}
            strokeDasharray={`${arc} ${length}`}
            transform="rotate(-90)"
            className={progress === null && !still ? classes.spin : undefined}
          />
        </>
      ) : (
        <circle r={RADIUS} strokeWidth={ring.width} strokeDasharray={ring.dash} />
      )}
      {ring.double ? <circle r={RADIUS - 4} strokeWidth={1.3} /> : null}
    </g>
  );
}

/** A standing picture of a device with its own `<svg>`, as large as its outline and the ring. */
export function DeviceToken({ device }: { device: MapDevice }) {
  const { width, height } = footprint(device);
  const [w, h] = [Math.max(width, 52) + 8, Math.max(height, 52) + 8];
  return (
    <svg width={w} height={h} viewBox={`${-w / 2} ${-h / 2} ${w} ${h}`} aria-hidden="true">
      <DeviceGlyph device={device} />
    </svg>
  );
}
