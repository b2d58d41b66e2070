import { expect, test } from "vitest";
import type { MapDevice } from "./device";
import { boxOfDevices, nameOnMap, nameSize } from "./framing";
import { fitViewport, toPixels } from "../plane/projection";

function device(x: number, y: number): MapDevice {
  const location = { x, y, theta: 0 };
  const base = { id: `${x}`, name: "", kind: "machine", device_class: "", status: "idle", doing: "", properties: [] };
  return { ...base, location, size: { x: 1, y: 1 } };
}

test("without a floor all devices are seen, wherever they stand", () => {
  const devices = [device(40, -30), device(52, -38)];
  const view = fitViewport(boxOfDevices(devices), 400, 250, { left: 0, right: 0, top: 0, bottom: 0 });
  for (const { location } of devices) {
    const at = toPixels([location.x, location.y]);
    expect(at.x * view.zoom + view.x).toBeGreaterThan(20);
    expect(at.x * view.zoom + view.x).toBeLessThan(380);
    expect(at.y * view.zoom + view.y).toBeGreaterThan(20);
    expect(at.y * view.zoom + view.y).toBeLessThan(230);
  }
});

test("an empty site has a box, too", () => {
  const { left, right } = boxOfDevices([]);
  expect(right).toBeGreaterThan(left);
});

test("names are cut where they would cover others, and never too small to be read", () => {
  expect(nameOnMap("Paint Mixer A")).toBe("Paint Mixer A");
  expect(nameOnMap("Labeller of the packaging line")).toBe("Labeller of the packaging…");
  expect(nameOnMap("x".repeat(200))).toHaveLength(28);
  for (const zoom of [0.2, 0.5, 1, 2]) expect(nameSize(zoom) * zoom).toBeGreaterThanOrEqual(10.5);
});
