/** A device, a named place, or a parameter; the map can be pressed instead. */
import { ActionIcon, Select, Tooltip } from "@mantine/core";
import { Crosshair } from "lucide-react";
import { useEffect, useRef } from "react";
import type { Place } from "@/program/document/document";
import { useOpenProgram } from "../../state/context";
import { type FieldPick, useUi } from "../../state/ui";
import { FieldFrame } from "./FieldFrame";
import classes from "../../panel.module.css";
import { useStepEditor } from "./stepEditor";

export type MachineFilter = (device: { gives: string[]; takes: string[]; methods: { name: string }[] }) => boolean;

interface PlaceFieldProps {
  label: string;
  field: string;
  accept?: MachineFilter;
  places?: boolean;
  placeholder?: string;
  value: Place | null;
  onChange: (place: Place | null) => void;
  /** The robots that can be chosen, too: `role:` with a role of the program, or `device:` with a robot's id. */
  robots?: readonly PlaceOption[];
  /** The role that is chosen. */
  role?: string | null;
  onRole?: (role: string) => void;
}

export interface PlaceOption {
  readonly value: string;
  readonly label: string;
  readonly disabled?: boolean;
}

const ROLE = "role:";

export function PlaceField(props: PlaceFieldProps) {
  const { label, field, accept, places = false, value, onChange, robots = [], role = null, onRole } = props;
  const { t } = useOpenProgram();
  const { disabled } = useStepEditor();
  const choices = usePlaceGroups(value, places, accept);
  const groups = robots.length > 0 ? [{ group: t("field.robots"), items: [...robots] }, ...choices] : choices;
  const choose = (next: string | null) =>
    next?.startsWith(ROLE) ? onRole?.(next.slice(ROLE.length)) : onChange(placeFrom(next, value));
  return (
    <FieldFrame label={label} field={field}>
      {({ control, note, bad }) => (
        <div className={classes.row}>
          <Select
            id={control}
            aria-describedby={bad ? note : undefined}
            error={bad}
            className={classes.grow}
            data={groups}
            value={role === null ? placeKey(value) : `${ROLE}${role}`}
            onChange={choose}
            placeholder={props.placeholder ?? t("field.choose")}
            searchable
            nothingFoundMessage={t("palette.none")}
            disabled={disabled}
            comboboxProps={{ withinPortal: true }}
          />
          <PickOnMap field={field} onPick={(device) => onChange({ device })} />
        </div>
      )}
    </FieldFrame>
  );
}

/** The next press on a machine is the field's answer, given to the field as it is then; one that has gone takes none. */
function PickOnMap({ field, onPick }: { field: string; onPick: (device: string) => void }) {
  const { t } = useOpenProgram();
  const { disabled } = useStepEditor();
  const latest = useRef(onPick);
  useEffect(() => {
    latest.current = onPick;
  });
  const waiting = useRef<FieldPick | null>(null);
  useEffect(() => () => useUi.setState((ui) => (ui.fieldPick === waiting.current ? { fieldPick: null } : ui)), []);
  const wait = () => {
    waiting.current = { field, choose: (device) => latest.current(device) };
    useUi.setState({ fieldPick: waiting.current });
  };
  return (
    <Tooltip label={t("field.pick_on_map")}>
      <ActionIcon variant="default" size={34} aria-label={t("field.pick_on_map")} onClick={wait} disabled={disabled}>
        <Crosshair size={16} aria-hidden="true" />
      </ActionIcon>
    </Tooltip>
  );
}

/** What can be chosen, by what it is; machines that do not suit stand there, too, but cannot be taken. */
function usePlaceGroups(value: Place | null, places: boolean, accept: MachineFilter = () => true) {
  const { devices, plan, t } = useOpenProgram();
  const { parameters } = useStepEditor();
  const machines = devices.filter((device) => device.kind !== "robot" && device.lifecycle !== "pending");
  const named = places ? (plan?.places ?? []) : [];
  const groups = [
    {
      group: t("field.machines"),
      items: machines.map((device) => ({
        value: `device:${device.id}`,
        label: device.name,
        disabled: !accept(device),
      })),
    },
    { group: t("field.places"), items: named.map(({ id, name }) => ({ value: `place:${id}`, label: name })) },
    {
      group: t("field.parameters"),
      items: parameters.map(({ name }) => ({ value: `param:${name}`, label: name })),
    },
    { group: t("field.point"), items: pointItems(value) },
  ];
  return groups.filter((group) => group.items.length > 0);
}

function pointItems(value: Place | null): { value: string; label: string }[] {
  if (!value || !("point" in value)) return [];
  return [{ value: "point", label: `${value.point[0]}, ${value.point[1]} m` }];
}

function placeKey(place: Place | null): string | null {
  if (!place) return null;
  if ("device" in place) return `device:${place.device}`;
  if ("place" in place) return `place:${place.place}`;
  return "point" in place ? "point" : `param:${place.param}`;
}

function placeFrom(key: string | null, before: Place | null): Place | null {
  if (key === null) return null;
  const [kind, ...rest] = key.split(":");
  const id = rest.join(":");
  if (kind === "device") return { device: id };
  if (kind === "place") return { place: id };
  return kind === "param" ? { param: id } : before;
}
