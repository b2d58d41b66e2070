// One virtual vehicle of vda-5050-lib in a process of its own; told more by one JSON object a line.
import { createRequire } from "node:module";
import { createInterface } from "node:readline";

const { AgvController, VirtualAgvAdapter } = createRequire(import.meta.url)("vda-5050-lib");
const config = JSON.parse(process.argv[2]);
const name = { manufacturer: config.manufacturer, serialNumber: config.serial };
const client = {
  interfaceName: "uagv",
  transport: { brokerUrl: `mqtt://127.0.0.1:${config.port}`, heartbeat: 5 },
  vdaVersion: "2.0.0",
};
const adapting = {
  initialPosition: { mapId: "hall", x: config.x, y: config.y, theta: 0, lastNodeId: "0" },
  vehicleSpeed: config.speed,
  timeLapse: config.timeLapse,
  tickRate: 20,
  initialBatteryCharge: 87.6,
};

let adapter;
class Adapter extends VirtualAgvAdapter {
  constructor(...asked) {
    super(...asked);
    adapter = this;
  }
}

const controlling = { agvAdapterType: Adapter, publishStateInterval: 2000, publishVisualizationInterval: 100 };
const vehicle = new AgvController(name, client, controlling, adapting);
await vehicle.start();
vehicle.updateFactsheet(config.factsheet);
if (config.tells) await vehicle.publish("factsheet", config.factsheet, { retainMessage: true });
console.log("ready");

for await (const line of createInterface({ input: process.stdin })) {
  const told = JSON.parse(line);
  if (told.do === "complain") vehicle.updateErrors(told.error, "add", true);
  if (told.do === "recover") vehicle.updateErrors(told.error, "remove", true);
  if (told.do === "hurry") adapter.options.timeLapse = told.timeLapse;
  if (told.do === "mode") vehicle.updateOperatingMode(told.mode);
}
