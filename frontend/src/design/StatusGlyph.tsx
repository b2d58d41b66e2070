/** The small sign of a status, told by its shape; for lines of text. */
export type StatusName = "idle" | "busy" | "done" | "waiting" | "warning" | "error" | "offline" | "pending";

const COLOURS: Readonly<Record<StatusName, string>> = {
  idle: "var(--idle)",
  busy: "var(--busy)",
  done: "var(--done)",
  waiting: "var(--warn)",
  warning: "var(--warn)",
  error: "var(--error)",
  offline: "var(--offline)",
  pending: "var(--pend)",
};

export function statusColour(status: StatusName): string {
  return COLOURS[status];
}

const STROKE = { fill: "none", stroke: "currentColor", strokeLinecap: "round", strokeLinejoin: "round" } as const;

function Shape({ status }: { status: StatusName }) {
  switch (status) {
    case "busy":
      return (
        <>
          <circle cx={8} cy={8} r={5.2} {...STROKE} strokeWidth={2.6} opacity={0.25} />
          <path d="M8 2.8a5.2 5.2 0 1 1-4.9 3.4" {...STROKE} strokeWidth={2.6} />
        </>
      );
    case "done":
      return (
        <>
          <circle cx={8} cy={8} r={6.6} fill="currentColor" />
          <path d="M5.2 8.2 7.2 10.2 10.9 6" {...STROKE} stroke="var(--panel)" strokeWidth={1.7} />
        </>
      );
    case "waiting":
      return (
        <>
          <rect x={1.6} y={1.6} width={12.8} height={12.8} rx={3.4} fill="var(--warn-fill)" />
          <path d="M6.2 5.2v5.6M9.8 5.2v5.6" {...STROKE} stroke="#171b26" strokeWidth={1.8} />
        </>
      );
    case "warning":
      return (
        <>
          <path d="M8 1.6 15 14H1Z" fill="var(--warn-fill)" stroke="var(--warn)" strokeLinejoin="round" />
          <path d="M8 6v3.6M8 11.8v.1" {...STROKE} stroke="#171b26" strokeWidth={1.5} />
        </>
      );
    case "error":
      return (
        <>
          <path d="M5.2 1.4h5.6l3.8 3.8v5.6l-3.8 3.8H5.2L1.4 10.8V5.2Z" fill="currentColor" />
          <path d="M8 4.8v3.8M8 11v.1" {...STROKE} stroke="var(--panel)" strokeWidth={1.8} />
        </>
      );
    case "offline":
      return (
        <>
          <circle cx={8} cy={8} r={5.6} {...STROKE} strokeWidth={1.5} strokeDasharray="1.6 2.4" />
          <path d="M4 12 12 4" {...STROKE} strokeWidth={1.5} />
        </>
      );
    case "pending":
      return (
        <>
          <rect x={2} y={2} width={12} height={12} rx={3} {...STROKE} strokeWidth={1.6} />
          <path d="M8 5v3.2l2 1.4" {...STROKE} strokeWidth={1.5} />
        </>
      );
    default:
      return <circle cx={8} cy={8} r={5} {...STROKE} strokeWidth={1.7} />;
  }
}

/** Decoration: the word stands beside it. */
export function StatusGlyph({ status, size = 14 }: { status: StatusName; size?: number }) {
  return (
    <svg
      width={size}
      height={size}
      viewBox="0 0 16 16"
      aria-hidden="true"
      style={{ color: COLOURS[status], flex: "none" }}
    >
      <Shape status={status} />
    </svg>
  );
}
