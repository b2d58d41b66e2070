/** What a For-each goes through: devices, places and values, in an order that the keyboard can change. */
import { Autocomplete } from "@mantine/core";
import { ArrowDown, ArrowUp, X } from "lucide-react";
import { useEffect, useRef, useState, type KeyboardEvent } from "react";
import { IconButton } from "@/design/IconButton";
import type { Value } from "@/program/document/document";
import { valueText } from "@/program/words/stepWords";
import { useOpenProgram } from "../../state/context";
import { FieldFrame } from "./FieldFrame";
import classes from "../../panel.module.css";
import { useStepEditor } from "./stepEditor";

/** The items with what the keys and buttons do to them; the row that was changed keeps the focus. */
function useItems() {
  const { step, set } = useStepEditor();
  const items = Array.isArray(step.params.items) ? (step.params.items as Value[]) : [];
  const list = useRef<HTMLUListElement>(null);
  const focus = (index: number) =>
    requestAnimationFrame(() => list.current?.querySelectorAll<HTMLElement>("li")[index]?.focus());
  const remove = (index: number) => {
    set("items", without(items, index));
    focus(Math.min(index, items.length - 2));
  };
  const shift = (index: number, by: -1 | 1) => {
    if (!(index + by in items)) return;
    set("items", shifted(items, index, by));
    focus(index + by);
  };
  const press = (event: KeyboardEvent, index: number) => {
    const by = event.key === "ArrowUp" ? -1 : event.key === "ArrowDown" ? 1 : 0;
    if (event.target !== event.currentTarget) return;
    if (by && event.altKey) shift(index, by);
    else if (by) focus(index + by);
    else if (event.key === "Delete" || event.key === "Backspace") remove(index);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return { items, list, remove, shift, press };
}

export function ItemsField() {
  const { t, speaker } = useOpenProgram();
  const { set, disabled } = useStepEditor();
  const { items, list, remove, shift, press } = useItems();
  return (
    <FieldFrame label={t("for_each.items")} field="items">
      {({ control, note, bad }) => (
        <>
          {items.length > 0 ? (
            <ul className={classes.items} ref={list} aria-label={t("for_each.keys")}>
              {items.map((item, index) => (
                <Row
                  key={index}
                  name={valueText(item, speaker) ?? "?"}
                  first={index === 0}
                  last={index === items.length - 1}
                  onPress={(event) => press(event, index)}
                  onShift={(by) => shift(index, by)}
                  onRemove={() => remove(index)}
                />
              ))}
            </ul>
          ) : null}
          <AddItem
            control={control}
            note={bad ? note : undefined}
            disabled={disabled}
            onAdd={(value) => set("items", [...items, value])}
          />
        </>
      )}
    </FieldFrame>
  );
}

function Row({
  name,
  first,
  last,
  onPress,
  onShift,
  onRemove,
}: {
  name: string;
  first: boolean;
  last: boolean;
  onPress: (event: KeyboardEvent) => void;
  onShift: (by: -1 | 1) => void;
  onRemove: () => void;
}) {
  const { t } = useOpenProgram();
  const { disabled } = useStepEditor();
  return (
    // oxlint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- keys move it; its buttons do the same
    <li className={classes.item} tabIndex={disabled ? -1 : 0} onKeyDown={disabled ? undefined : onPress}>
      <span className={classes.grow}>{name}</span>
      <IconButton label={t("for_each.up", { name })} disabled={disabled || first} onClick={() => onShift(-1)}>
        <ArrowUp size={14} aria-hidden="true" />
      </IconButton>
      <IconButton label={t("for_each.down", { name })} disabled={disabled || last} onClick={() => onShift(1)}>
        <ArrowDown size={14} aria-hidden="true" />
      </IconButton>
      <IconButton label={t("for_each.remove", { name })} disabled={disabled} onClick={onRemove}>
        <X size={14} aria-hidden="true" />
      </IconButton>
    </li>
  );
}

/** Machines and places by their names; a machine goes before a place of the same name. */
function useAddable() {
  const { t, devices, plan } = useOpenProgram();
  const known = new Map<string, Value>();
  for (const place of plan?.places ?? []) known.set(place.name, { at: { place: place.id } });
  for (const device of devices) if (device.kind !== "robot") known.set(device.name, { at: { device: device.id } });
  const machines = devices.filter((device) => device.kind !== "robot").map((device) => device.name);
  const places = (plan?.places ?? []).map((place) => place.name).filter((name) => !machines.includes(name));
  const groups = [
    { group: t("field.machines"), items: [...new Set(machines)] },
    { group: t("field.places"), items: [...new Set(places)] },
  ];
  return { known, groups };
}

function AddItem({
  control,
  note,
  disabled,
  onAdd,
}: {
  control: string;
  note: string | undefined;
  disabled: boolean;
  onAdd: (value: Value) => void;
}) {
  const { t } = useOpenProgram();
  const { groups, text, setText, round, input, chosen, add } = useAdding(onAdd);
  return (
    <Autocomplete
      key={round}
      id={control}
      ref={input}
      aria-describedby={note}
      data={groups}
      value={text}
      placeholder={t("for_each.add")}
      disabled={disabled}
      onChange={(next) => {
        // The field writes a chosen name into itself after it has been added.
        setText(next === chosen.current ? "" : next);
        chosen.current = null;
      }}
      onOptionSubmit={(name) => {
        add(name);
        chosen.current = name;
      }}
      onKeyDown={(event) => {
        if (event.key !== "Enter" || event.defaultPrevented || !text.trim()) return;
        event.preventDefault(); // the field goes on, for the next one
        add(text);
      }}
    />
  );
}

/** The text as it is written; each thing that was added makes the field anew, with the focus. */
function useAdding(onAdd: (value: Value) => void) {
  const { known, groups } = useAddable();
  const [text, setText] = useState("");
  const [round, setRound] = useState(0);
  const input = useRef<HTMLInputElement>(null);
  const chosen = useRef<string | null>(null);
  useEffect(() => {
    if (round > 0) input.current?.focus();
  }, [round]);
  const add = (written: string) => {
    const value = written.trim();
    if (!value) return;
    onAdd(known.get(value) ?? itemFrom(value));
    setText("");
    setRound(round + 1);
  };
  return { groups, text, setText, round, input, chosen, add };
}

/** What is no device and no place is a number or a text. */
function itemFrom(text: string): Value {
  const number = Number(text.replace(",", "."));
  return Number.isFinite(number) ? number : text;
}

function without(items: readonly Value[], index: number): Value[] {
  return items.filter((_, at) => at !== index);
}

function shifted(items: readonly Value[], index: number, by: -1 | 1): Value[] {
  const next = without(items, index);
  next.splice(index + by, 0, items[index] ?? null);
  return next;
}
