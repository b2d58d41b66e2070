/** What a small map shows where there is no floor. Pure. */
import { footprint, type MapDevice } from "./device";
import { boxAround, PIXELS_PER_METRE, toPixels, type Box } from "./projection";

/** Drawing pixels; a lone machine is not shown larger than life. */
const MARGIN = 3 * PIXELS_PER_METRE;

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
