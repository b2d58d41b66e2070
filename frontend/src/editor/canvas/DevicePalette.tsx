/** Choosing a device by typing: the keyboard's way through a gesture. */
import { Crosshair, MapPin } from "lucide-react";
import { type ReactNode, useLayoutEffect, useRef, useState } from "react";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import type { SiteDevice } from "@/program/surroundings";
import { rowPress } from "@/shell/palette/rowPress";
import { enterPlace, useMode } from "../keyboard/modes";
import { type OpenProgram, useOpenProgram } from "../state/context";
import { focusMap } from "../state/focus";
import { createAtPlace } from "../state/newStep";
import { askOf, stepBack, suits, type Gesture } from "../state/tool";
import { useUi } from "../state/ui";
import classes from "./float.module.css";

const ASKS = ["source", "target", "goal", "device"];

export function DevicePalette({ onChoose }: { onChoose: (device: string) => void }) {
  const gesture = useUi((ui) => ui.gesture);
  const ask = askOf(gesture);
  const placing = useMode((state) => state.mode !== null);
  if (!gesture.byKeyboard || placing || !ASKS.includes(ask)) return null;
  // A new question is a new field, so that what was typed for the last one can never run into it.
  return <Palette key={ask} ask={ask} gesture={gesture} onChoose={onChoose} />;
}

function Palette({ ask, gesture, onChoose }: { ask: string; gesture: Gesture; onChoose: (device: string) => void }) {
  const open = useOpenProgram();
  const { t, devices, surroundings } = open;
  const [text, setText] = useState("");
  const [at, setAt] = useState(0);
  const input = useRef<HTMLInputElement>(null);
  useLayoutEffect(() => input.current?.focus(), []);
  const source = gesture.source ? surroundings.devices.get(gesture.source) : undefined;
  const wanted = text.trim().toLowerCase();
  const fitting = devices.filter((device) => suits(gesture, device, source));
  const found = [...fitting.map(asEntry), ...(ask === "goal" ? goals(open) : [])].filter(({ name }) =>
    name.toLowerCase().includes(wanted),
  );
  const choose = (id: string | undefined) => {
    const entry = found.find((each) => each.id === id);
    if (entry?.take) entry.take();
    else if (entry) onChoose(entry.id);
  };
  return (
    <div className={classes.palette}>
      <input
        ref={input}
        value={text}
        role="combobox"
        aria-expanded="true"
        aria-controls="device-palette"
        aria-activedescendant={found[at] ? `palette-${found[at].id}` : undefined}
        aria-label={t(`help.${ask}`)}
        placeholder={t("palette.placeholder")}
        onChange={(event) => {
          setText(event.target.value);
          setAt(0);
        }}
        onKeyDown={(event) => {
          if (event.key === "Enter") choose(found[at]?.id);
          else if (event.key === "ArrowDown") setAt(Math.min(found.length - 1, at + 1));
          else if (event.key === "ArrowUp") setAt(Math.max(0, at - 1));
          else if (event.key === "Escape") useUi.setState({ gesture: stepBack(gesture) });
          else return;
          event.preventDefault();
          event.stopPropagation();
        }}
      />
      <Found found={found} at={at} choose={choose} />
    </div>
  );
}

interface Entry {
  readonly id: string;
  readonly name: string;
  readonly icon: ReactNode;
  /** What choosing it does; without it, it is a device. */
  readonly take?: () => void;
}

function asEntry({ id, name, device_class }: SiteDevice): Entry {
  return { id, name, icon: <DeviceIcon deviceClass={device_class} size={16} /> };
}

/** Where else a robot can drive: to a named place, or to a point that is found with arrow keys. */
function goals(open: OpenProgram): Entry[] {
  const places = (open.plan?.places ?? []).map((place) => ({
    id: `place ${place.id}`,
    name: place.name,
    icon: <MapPin size={16} aria-hidden="true" />,
    take: () => createAtPlace(open, place),
  }));
  const floor = {
    id: "floor",
    name: open.t("palette.floor"),
    icon: <Crosshair size={16} aria-hidden="true" />,
    take: () => {
      enterPlace(open);
      focusMap();
    },
  };
  return [...places, floor];
}

interface FoundProps {
  found: readonly Entry[];
  at: number;
  choose: (id: string) => void;
}

function Found({ found, at, choose }: FoundProps) {
  const { t } = useOpenProgram();
  return (
    <ul id="device-palette" role="listbox" aria-label={t("palette.list")}>
      {found.map((device, index) => (
        <li
          key={device.id}
          id={`palette-${device.id}`}
          role="option"
          aria-selected={index === at}
          {...rowPress(() => choose(device.id))}
        >
          {device.icon}
          {device.name}
        </li>
      ))}
      {found.length === 0 ? <li className={classes.none}>{t("palette.none")}</li> : null}
    </ul>
  );
}
