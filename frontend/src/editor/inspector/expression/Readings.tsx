/** The current readings that a value looks at, straight from the live store. */
import { useLiveStore } from "@/live/store";
import { ownEntry } from "@/design/ownEntry";
import { formatReading } from "@/i18n/format";
import { readingsOf } from "../../edits/conditions";
import type { Value } from "@/program/document/document";
import { withUnit } from "@/program/words/stepWords";
import { useOpenProgram } from "../../state/context";
import classes from "../../panel.module.css";

export function Readings({ value }: { value: Value | undefined }) {
  const { document } = useOpenProgram();
  return readingsOf(value ?? null, document.roles).map(([device, name]) => (
    <Reading key={`${device}\n${name}`} device={device} name={name} />
  ));
}

export function Reading({ device, name }: { device: string; name: string }) {
  const { t, devices } = useOpenProgram();
  const facts = devices.find((each) => each.id === device);
  const unit = facts?.properties.find((each) => each.name === name)?.unit ?? "";
  const value = useReading(device, name);
  if (!facts || value === null) return null;
  return (
    <p className={classes.now}>{t("condition.now", { device: facts.name, value: withUnit(String(value), unit) })}</p>
  );
}

/** A reading as it is now, in the words of the screen. */
export function useReading(device: string, name: string) {
  return useLiveStore((live) => {
    const found = ownEntry(live.deviceById, device)?.properties.find((each) => each.name === name)?.value;
    return typeof found === "number" ? formatReading(found) : (found ?? null);
  });
}
