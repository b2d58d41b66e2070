/** Icons as paths for canvases, on their grid of 24 pixels. */
import { iconBody } from "@/design/VipoIcon";

const known = new Map<string, Path2D>();

/** An icon's lines; those of a Pick-and-Drop are a box, as on its chip. */
export function iconPath(name: string): Path2D {
  const before = known.get(name);
  if (before) return before;
  const path = name === BOX ? boxPath() : pathOf(iconBody(name));
  known.set(name, path);
  return path;
}

export const BOX = ":box";

function boxPath(): Path2D {
  return new Path2D("M12 2.5 20.5 7.3V16.7L12 21.5 3.5 16.7V7.3ZM3.5 7.3 12 12.1 20.5 7.3M12 12.1V21.5");
}

/** Icons are drawn with paths, circles and rounded rectangles only. */
function pathOf(body: string): Path2D {
  const path = new Path2D();
  for (const [, shape, attributes = ""] of body.matchAll(/<(path|circle|rect)\b([^>]*?)\/?>/g)) {
    const value = (name: string) => new RegExp(`\\b${name}="([^"]*)"`).exec(attributes)?.[1] ?? "0";
    const number = (name: string) => Number(value(name));
    if (shape === "path") path.addPath(new Path2D(value("d")));
    else if (shape === "circle") path.addPath(circle(number("cx"), number("cy"), number("r")));
    else path.roundRect(number("x"), number("y"), number("width"), number("height"), number("rx"));
  }
  return path;
}

function circle(x: number, y: number, radius: number): Path2D {
  const path = new Path2D();
  path.arc(x, y, radius, 0, Math.PI * 2);
  return path;
}
