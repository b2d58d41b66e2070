/** Where the numbers of findings stand on the map. Pure. */
import type { PixelPoint } from "@/map/plane/paths";

/** The same places in order; who would lie over an earlier one stands to the right of it, so that every number is seen. */
export function markPlaces(wanted: readonly PixelPoint[], apart: number): PixelPoint[] {
  const places: PixelPoint[] = [];
  for (const { x, y } of wanted) {
    let right = x;
    for (let blocking = inWay(places, right, y, apart); blocking; blocking = inWay(places, right, y, apart))
      right = blocking.x + apart;
    places.push({ x: right, y });
  }
  return places;
}

function inWay(places: readonly PixelPoint[], x: number, y: number, apart: number): PixelPoint | undefined {
  return places.find((place) => place.x + apart > x && Math.hypot(place.x - x, place.y - y) < apart);
}
