/** A solid route: a robot drives here. For use inside an SVG in drawing pixels. */
import { chevrons, roundedPath, towards, angleOf, type PixelPoint } from "./plane/paths";

const HEAD = 11;

export function PathLine({
  points,
  colour = "var(--motion)",
  opacity = 1,
  dashed = false,
  wide = false,
}: {
  points: readonly PixelPoint[];
  colour?: string;
  opacity?: number;
  dashed?: boolean;
  wide?: boolean;
}) {
  const [end, before, start] = [points.at(-1), points.at(-2), points[0]];
  if (!end || !before || !start) return null;
  const line = roundedPath([...points.slice(0, -1), towards(end, before, HEAD - 2)]);
  return (
    <g fill="none" strokeLinecap="round" strokeLinejoin="round" opacity={opacity}>
      {wide ? <path d={line} stroke={colour} strokeWidth={13} opacity={0.16} /> : null}
      <path d={line} stroke="var(--casing)" strokeWidth={7.5} />
      <path d={line} stroke={colour} strokeWidth={3} strokeDasharray={dashed ? "7 6" : undefined} />
      {chevrons(points).map((at, index) => (
        <path
          key={index}
          d="M-3.5 -5 1.5 0 -3.5 5"
          stroke={colour}
          strokeWidth={2.2}
          transform={`translate(${at.x} ${at.y}) rotate(${at.angle})`}
        />
      ))}
      <path
        d="M0 0 -14 -7.5 -11 0 -14 7.5Z"
        fill={colour}
        stroke={colour}
        strokeWidth={1}
        transform={`translate(${end.x} ${end.y}) rotate(${angleOf(before, end)})`}
      />
      <circle cx={start.x} cy={start.y} r={4.6} fill="var(--floor)" stroke={colour} strokeWidth={2.2} />
    </g>
  );
}
