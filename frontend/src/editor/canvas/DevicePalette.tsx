/** Choosing a device by typing: the keyboard's way through a gesture. */
import { useLayoutEffect, useRef, useState } from "react";
import { DeviceIcon } from "@/map/devices/DeviceIcon";
import { useOpenProgram } from "../state/context";
import { askOf, stepBack, suits, type Gesture } from "../state/tool";
import { useUi } from "../state/ui";
import classes from "./float.module.css";

const ASKS = ["source", "target", "goal", "device"];

export function DevicePalette({ onChoose }: { onChoose: (device: string) => void }) {
  const gesture = useUi((ui) => ui.gesture);
  const ask = askOf(gesture);
  if (!gesture.byKeyboard || !ASKS.includes(ask)) return null;
  // A new question is a new field, so that what was typed for the last one can never run into it.
  return <Palette key={ask} ask={ask} gesture={gesture} onChoose={onChoose} />;
}

function Palette({ ask, gesture, onChoose }: { ask: string; gesture: Gesture; onChoose: (device: string) => void }) {
  const { t, devices, surroundings } = useOpenProgram();
  const [text, setText] = useState("");
  const [at, setAt] = useState(0);
  const input = useRef<HTMLInputElement>(null);
  useLayoutEffect(() => input.current?.focus(), []);
  const source = gesture.source ? surroundings.devices.get(gesture.source) : undefined;
  const found = devices.filter(
    (device) => suits(gesture, device, source) && device.name.toLowerCase().includes(text.trim().toLowerCase()),
  );
  const choose = (id: string | undefined) => {
    if (id) onChoose(id);
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

interface FoundProps {
  found: readonly { id: string; name: string; device_class: string }[];
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
          onPointerDown={(event) => {
            event.preventDefault();
            choose(device.id);
          }}
        >
          <DeviceIcon deviceClass={device.device_class} size={16} />
          {device.name}
        </li>
      ))}
      {found.length === 0 ? <li className={classes.none}>{t("palette.none")}</li> : null}
    </ul>
  );
}
