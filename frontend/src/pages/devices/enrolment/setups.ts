/** What a device is set up with, as the file or the commands that it takes. Pure. */
import type { ExpectedDevice } from "@/api/types";
import type { Dialect } from "../description/source";

export const DEVICE_SORTS = ["esp32", "ros", "other"] as const;
export type DeviceSort = (typeof DEVICE_SORTS)[number];

export interface Setup {
  /** The file's name; null where it is for a terminal. */
  file: string | null;
  text: string;
  dialect: Dialect;
}

interface Broker {
  host: string;
  port: number;
  secure: boolean;
}

const UNKNOWN: Broker = { host: "broker.example", port: 8883, secure: true };

/** The parts of `mqtt://host:port/`; a host to be replaced where nobody has said it. */
export function brokerOf(address: string): Broker {
  const found = /^(mqtts?):\/\/(?:\[([^\]]+)\]|([^/:]+))(?::(\d+))?/.exec(address);
  if (!found) return UNKNOWN;
  const secure = found[1] === "mqtts";
  return { host: found[2] ?? found[3] ?? UNKNOWN.host, port: Number(found[4] ?? (secure ? 8883 : 1883)), secure };
}

/** Whether only the same computer reaches the broker. */
export function isLocal(address: string): boolean {
  const { host } = brokerOf(address);
  return host === "localhost" || host === "::1" || host.startsWith("127.");
}

/** JSON with a line for each key. */
function json(value: Record<string, unknown>): string {
  const lines = Object.entries(value).map(([key, each]) => `  ${JSON.stringify(key)}: ${JSON.stringify(each)}`);
  return `{\n${lines.join(",\n")}\n}`;
}

function common(device: ExpectedDevice): Record<string, unknown> {
  const { host, port, secure } = brokerOf(device.broker);
  const door = { id: device.id, site: device.site, host, port };
  return { ...door, ...(secure ? { ca: "ca.crt" } : {}), password: device.credential };
}

function commands(device: ExpectedDevice): string {
  const { host, port, secure } = brokerOf(device.broker);
  const who = `-h ${host} -p ${port}${secure ? " --cafile ca.crt" : ""} -i ${device.id} -u ${device.id} -P '${device.credential}'`;
  const topic = `vipo/v1/dev/${device.id}`;
  return [
    "# its description, in any form, from a file",
    `mosquitto_pub ${who} -q 1 -r -t ${topic}/up/desc -f ${device.id}.ttl`,
    "# it is there",
    `mosquitto_pub ${who} -q 1 -r -t ${topic}/up/presence -m '{"s": "online", "boot": 1}'`,
  ].join("\n");
}

/** What to copy into a device of that sort. */
export function setupOf(sort: DeviceSort, device: ExpectedDevice): Setup {
  switch (sort) {
    case "esp32":
      return {
        file: "config.json",
        text: json({ wifi_name: "…", wifi_password: "…", ...common(device), driver: "mixer", location: [0, 0, 0, 0] }),
        dialect: "json",
      };
    case "ros":
      return {
        file: "robot.json",
        text: json({ ...common(device), ros: 1, radius_m: 0.18, speed_m_s: 0.22, capacity: 2, home: [0, 0, 0] }),
        dialect: "json",
      };
    case "other":
      return { file: null, text: commands(device), dialect: "script" };
  }
}
