/** The small badge of a status, told by its shape; 16 px, middle at 0, 0, for use inside an SVG. */
import type { DeviceStatus } from "./device";

export function StatusMark({ status }: { status: DeviceStatus }) {
  switch (status) {
    case "done":
      return <TickMark colour="var(--done)" />;
    case "error":
      return <OctagonMark />;
    case "waiting":
      return <BarsMark />;
    case "warning":
      return (
        <g>
          <path d="M0 -8 8.4 6.6H-8.4Z" fill="var(--warn-fill)" stroke="var(--panel)" strokeWidth={1.4} />
          <path d="M0 -2.6V2M0 4.4v.1" stroke="#171b26" strokeWidth={1.7} strokeLinecap="round" />
        </g>
      );
    case "offline":
      return (
        <g>
          <circle r={7} fill="var(--panel)" stroke="var(--offline)" strokeWidth={1.3} />
          <path d="M-4 4 4 -4" stroke="var(--offline)" strokeWidth={1.6} strokeLinecap="round" />
        </g>
      );
    case "pending":
      return (
        <g fill="none" stroke="var(--pend)" strokeLinecap="round">
          <rect x={-6.5} y={-6.5} width={13} height={13} rx={3.4} fill="var(--panel)" strokeWidth={1.4} />
          <path d="M0 -3.2V0.4L2.4 1.8" strokeWidth={1.5} />
        </g>
      );
    default:
      return null;
  }
}

export function TickMark({ colour }: { colour: string }) {
  return (
    <g>
      <circle r={7.4} fill={colour} stroke="var(--panel)" strokeWidth={1.4} />
      <path
        d="M-3.2 0.2 -0.9 2.6 3.3 -2.4"
        fill="none"
        stroke="var(--panel)"
        strokeWidth={1.8}
        strokeLinecap="round"
        strokeLinejoin="round"
      />
    </g>
  );
}

export function OctagonMark() {
  return (
    <g>
      <path
        d="M-3.2 -7.8H3.2L7.8 -3.2V3.2L3.2 7.8H-3.2L-7.8 3.2V-3.2Z"
        fill="var(--error)"
        stroke="var(--panel)"
        strokeWidth={1.4}
      />
      <path d="M0 -3.8V0.8M0 3.6v.1" stroke="var(--panel)" strokeWidth={1.9} strokeLinecap="round" />
    </g>
  );
}

export function BarsMark() {
  return (
    <g>
      <rect
        x={-7.4}
        y={-7.4}
        width={14.8}
        height={14.8}
        rx={3.6}
        fill="var(--warn-fill)"
        stroke="var(--panel)"
        strokeWidth={1.4}
      />
      <path d="M-2.1 -3.2V3.2M2.1 -3.2V3.2" stroke="#171b26" strokeWidth={2} strokeLinecap="round" />
    </g>
  );
}
