import { describe, expect, it } from "vitest";
import { brokerOf, isLocal, setupOf } from "./setups";

const DEVICE = { id: "mixer-7", site: "hall", credential: "k".repeat(32), broker: "mqtts://broker.works:8884/" };

describe("a broker's address", () => {
  it.each([
    ["mqtt://127.0.0.1:18830/", { host: "127.0.0.1", port: 18830, secure: false }],
    ["mqtts://broker.works", { host: "broker.works", port: 8883, secure: true }],
    ["mqtt://[::1]:1884/", { host: "::1", port: 1884, secure: false }],
    ["", { host: "broker.example", port: 8883, secure: true }],
  ])("%s is read", (address, parts) => {
    expect(brokerOf(address)).toEqual(parts);
  });
});

it.each([
  ["mqtt://127.0.0.1:1883/", true],
  ["mqtt://localhost", true],
  ["mqtts://broker.works", false],
  ["", false],
])("who reaches %s is known", (address, local) => {
  expect(isLocal(address)).toBe(local);
});

describe("what a device is set up with", () => {
  it("is the configuration of an ESP32, with its own key and the broker's certificate", () => {
    const { file, text } = setupOf("esp32", DEVICE);
    expect(file).toBe("config.json");
    expect(JSON.parse(text)).toMatchObject({
      id: "mixer-7",
      site: "hall",
      host: "broker.works",
      port: 8884,
      ca: "ca.crt",
      password: DEVICE.credential,
    });
  });
  it("names no certificate where the broker has none", () => {
    expect(JSON.parse(setupOf("ros", { ...DEVICE, broker: "mqtt://h:1/" }).text)).not.toHaveProperty("ca");
  });
  it("is two commands for anything that speaks MQTT", () => {
    const { file, text } = setupOf("other", DEVICE);
    expect(file).toBeNull();
    expect(text).toContain("-i mixer-7 -u mixer-7 -P '" + DEVICE.credential + "'");
    expect(text).toContain("-t vipo/v1/dev/mixer-7/up/desc");
  });
});
