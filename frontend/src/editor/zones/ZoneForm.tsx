/** The inspector of a zone: its name, its rule, its speed. */
import { Radio, Select, TextInput } from "@mantine/core";
import { Trash2, X } from "lucide-react";
import { useEffect, useState } from "react";
import { IconButton } from "@/design/IconButton";
import { NumberField } from "@/design/NumberField";
import { VipoIcon } from "@/design/VipoIcon";
import { formatNumber, withUnit } from "@/i18n/format";
import { useGestures, selectZone } from "../state/gestures";
import { FormBody } from "../canvas/FormBody";
import inspector from "../panel.module.css";
import type { Zone } from "@/program/document/document";
import { soundZones, zoneIcon } from "@/program/canvas/Zones";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { changeZone, removeZone } from "./zoneTool";
import { areaOf, ZONE_RULES } from "./shape";

export function ZoneForm() {
  const { document } = useOpenProgram();
  const id = useGestures((ui) => ui.zone);
  const steps = useUi((ui) => ui.selected.length);
  const [, zone] = soundZones(document).find(([each]) => each === id) ?? [null, null];
  useEffect(() => useUi.subscribe((ui) => ui.selected.length > 0 && useGestures.setState({ zone: null })), []);
  return id !== null && zone && steps === 0 ? <Panel key={id} id={id} zone={zone} /> : null;
}

function Panel({ id, zone }: { id: string; zone: Zone }) {
  const open = useOpenProgram();
  const { t, canEdit } = open;
  const area = withUnit(formatNumber(areaOf(zone.points), 1), "m²");
  return (
    <aside className={inspector.panel} aria-label={t("gesture.zone.label")}>
      <header className={inspector.head}>
        <span className={inspector.icon} style={{ color: "var(--note)", background: "var(--note-soft)" }}>
          <VipoIcon name={zoneIcon(zone)} size={20} />
        </span>
        <span className={inspector.title}>
          <h2>{t("gesture.zone.label")}</h2>
          <span>{zone.name}</span>
        </span>
        {canEdit ? (
          <IconButton label={t("gesture.zone.delete")} onClick={() => removeZone(open, id)}>
            <Trash2 size={16} aria-hidden="true" />
          </IconButton>
        ) : null}
        <IconButton label={t("gesture.zone.close")} onClick={() => selectZone(null)}>
          <X size={17} aria-hidden="true" />
        </IconButton>
      </header>
      <FormBody>
        <NameField id={id} zone={zone} />
        <RuleField id={id} zone={zone} />
        {zone.rule === "slow" ? <SpeedField id={id} zone={zone} /> : null}
        {zone.rule === "door" ? <DoorField id={id} zone={zone} /> : null}
        <p className={inspector.now}>{t("gesture.zone.corners", { count: zone.points.length, area })}</p>
      </FormBody>
    </aside>
  );
}

/** Written down when the field is left, so that a name is one entry to undo. */
function NameField({ id, zone }: { id: string; zone: Zone }) {
  const open = useOpenProgram();
  const [name, setName] = useState(zone.name);
  useEffect(() => setName(zone.name), [zone.name]);
  const keep = () => {
    const next = name.trim();
    if (next && next !== zone.name) changeZone(open, id, { name: next });
    else setName(zone.name);
  };
  return (
    <TextInput
      label={open.t("gesture.zone.name")}
      value={name}
      disabled={!open.canEdit}
      onChange={(event) => setName(event.currentTarget.value)}
      onBlur={keep}
    />
  );
}

function RuleField({ id, zone }: { id: string; zone: Zone }) {
  const open = useOpenProgram();
  return (
    <Radio.Group
      label={open.t("gesture.zone.rule")}
      value={zone.rule}
      onChange={(rule) => changeZone(open, id, { rule })}
    >
      <div className={inspector.field} style={{ marginTop: 8 }}>
        {ZONE_RULES.map((rule) => (
          <Radio key={rule} value={rule} label={open.t(`gesture.zone.${rule}`)} disabled={!open.canEdit} />
        ))}
      </div>
    </Radio.Group>
  );
}

function SpeedField({ id, zone }: { id: string; zone: Zone }) {
  const open = useOpenProgram();
  return (
    <NumberField
      label={open.t("gesture.zone.speed")}
      value={zone.speed_m_s ?? ""}
      min={0.05}
      max={2}
      step={0.05}
      decimalScale={2}
      disabled={!open.canEdit}
      onChange={(speed) => changeZone(open, id, { speed_m_s: typeof speed === "number" ? speed : null })}
    />
  );
}

/** Any machine with something that needs no values may be a door; whether it opens, the checks say. */
function DoorField({ id, zone }: { id: string; zone: Zone }) {
  const open = useOpenProgram();
  const devices = open.devices.filter(
    (device) =>
      device.id === zone.door ||
      (device.kind === "machine" &&
        device.lifecycle === "approved" &&
        device.methods.some((method) => !method.parameters.some((parameter) => parameter.required))),
  );
  const known = devices.map((device) => ({ value: device.id, label: device.name }));
  const named =
    zone.door && !devices.some((device) => device.id === zone.door) ? [{ value: zone.door, label: zone.door }] : [];
  return (
    <Select
      label={open.t("gesture.zone.door_device")}
      description={open.t("gesture.zone.door_help")}
      placeholder={open.t("gesture.zone.door_choose")}
      data={[...known, ...named]}
      value={zone.door ?? null}
      searchable
      allowDeselect={false}
      disabled={!open.canEdit}
      onChange={(door) => changeZone(open, id, { door })}
    />
  );
}
