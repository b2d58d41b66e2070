/** What a small map shows where there is no floor. Pure. */
import { footprint, type MapDevice } from "./device";
import { boxAround, PIXELS_PER_METRE, toPixels, type Box } from "../plane/projection";

/** Drawing pixels; a lone machine is not shown larger than life. */
const MARGIN = 3 * PIXELS_PER_METRE;

const LONGEST = 28;

/** How large names are written, in drawing pixels. */
export const NAME_SIZE = 11.5;

/** A name as it stands on a map, cut behind a word: long ones would cover the others. */
export function nameOnMap(name: string): string {
  if (name.length <= LONGEST) return name;
  const cut = name.slice(0, LONGEST - 1);
  const words = cut.replace(/\s+\S*$/, "");
  return `${words || cut}…`;
}

/** How large a single name is written, in drawing pixels, so that it can be read at any zoom. */
export function nameSize(zoom: number): number {
  return Math.max(NAME_SIZE, 10.5 / zoom);
}

/** The box in which devices stand, with room around them. */
export function boxOfDevices(devices: readonly MapDevice[]): Box {
  const corners = devices.flatMap((device) => {
    const { x, y } = toPixels([device.location.x, device.location.y]);
    const { width, height } = footprint(device);
    return [
      { x: x - width / 2 - MARGIN, y: y - height / 2 - MARGIN },
      { x: x + width / 2 + MARGIN, y: y + height / 2 + MARGIN },
    ];
  });
  return boxAround(corners) ?? { left: -MARGIN, top: -MARGIN, right: MARGIN, bottom: MARGIN };
}
