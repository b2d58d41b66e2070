/** The painting factory of the examples, as the screens read a site; for tests. */
import type { SiteDevice } from "@/program/surroundings";
import factory from "../../../../examples/painting-factory.json";
import type { TemplateSite } from "./templates";

/** Its devices with `changes` to some of them, by their ids; null takes one away. */
export function exampleSite(changes: Readonly<Record<string, Partial<SiteDevice> | null>> = {}): TemplateSite {
  const devices = factory.devices.flatMap((device): SiteDevice[] => {
    const change = changes[device.id];
    if (change === null) return [];
    const { x, y, theta } = device.pose;
    const read = {
      ...device,
      status: "idle",
      doing: "",
      lifecycle: "approved",
      location: { x, y, theta },
      gives: "gives" in device ? device.gives : [],
      takes: "takes" in device ? device.takes : [],
      properties: device.properties.map((each) => ({ ...each, value: null })),
    };
    return [{ ...(read as unknown as SiteDevice), ...change }];
  });
  const places = factory.places.map((place) => ({ ...place, theta: 0 }));
  return { devices, places };
}
