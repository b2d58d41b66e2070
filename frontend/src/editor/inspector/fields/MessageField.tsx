/** A sentence for people with values in it: known names and readings are put in with braces around them. */
import { Select, Textarea } from "@mantine/core";
import { useEffect, useMemo, useRef, useState } from "react";
import { insertsFor, messageFrom, messageText, type Insert } from "../../edits/message";
import type { Value } from "@/program/document/document";
import { readingsOfRoles } from "@/program/robotReadings";
import { valueText } from "@/program/words/stepWords";
import { roleName } from "@/program/words/valueWords";
import { useOpenProgram } from "../../state/context";
import { FieldFrame } from "./FieldFrame";
import classes from "../../panel.module.css";
import { useStepEditor } from "./stepEditor";

/** The text as it is being written; it is kept when the field is left, or when a value is put in. */
function useMessage(field: string) {
  const { speaker } = useOpenProgram();
  const { step, set } = useStepEditor();
  const value = step.params[field] as Value | undefined;
  const labelOf = useMemo(() => (each: Value) => valueText(each, { ...speaker, full: true }) ?? "?", [speaker]);
  const offered = useOffered();
  const inserts = useMemo(
    () =>
      insertsFor(
        value,
        offered.flatMap((each) => each.inserts),
        labelOf,
      ),
    [value, offered, labelOf],
  );
  const stored = messageText(value, inserts);
  const [text, setText] = useState(stored);
  useEffect(() => setText(stored), [stored]);
  const area = useRef<HTMLTextAreaElement>(null);
  const keep = (next: string) => {
    if (next === stored) return;
    set(field, messageFrom(next, inserts));
  };
  const insert = (name: string | null) => {
    if (!name) return;
    const at = area.current?.selectionStart ?? text.length;
    const next = `${text.slice(0, at)}{${name}}${text.slice(at)}`;
    setText(next);
    keep(next);
    area.current?.focus();
  };
  const groups = useMemo(() => {
    const labels = new Map(inserts.map((each) => [JSON.stringify(each.value), each.label]));
    return offered.map((each) => ({
      group: each.group,
      items: each.inserts.map(({ label, value: put }) => labels.get(JSON.stringify(put)) ?? label),
    }));
  }, [offered, inserts]);
  return { text, setText, keep, insert, area, groups };
}

export function MessageField({ label, field, placeholder }: { label: string; field: string; placeholder?: string }) {
  const { t } = useOpenProgram();
  const { disabled } = useStepEditor();
  const { text, setText, keep, insert, area, groups } = useMessage(field);
  return (
    <FieldFrame label={label} field={field}>
      {({ control, note, bad }) => (
        <>
          <Textarea
            ref={area}
            id={control}
            aria-describedby={bad ? note : undefined}
            error={bad}
            value={text}
            placeholder={placeholder}
            autosize
            minRows={2}
            maxRows={6}
            disabled={disabled}
            onChange={(event) => setText(event.currentTarget.value)}
            onBlur={() => keep(text)}
          />
          <Select
            size="xs"
            className={classes.between}
            aria-label={t("message.insert")}
            placeholder={t("message.insert")}
            data={groups}
            value={null}
            onChange={insert}
            searchable
            selectFirstOptionOnChange
            disabled={disabled || groups.length === 0}
          />
        </>
      )}
    </FieldFrame>
  );
}

/** Names first, then the readings of the program's robots and of each device. */
function useOffered(): readonly { group: string; inserts: readonly Insert[] }[] {
  const { devices, document, speaker, t } = useOpenProgram();
  const { parameters } = useStepEditor();
  return useMemo(() => {
    const names = parameters.map((each) => ({ label: each.name, value: { param: each.name } }));
    const robots = readingsOfRoles(document, devices).map(({ role, readings: reported }) => ({
      group: roleName(role, speaker),
      inserts: reported.map((each): Insert => ({
        label: `${roleName(role, speaker)} ${each.name}`,
        value: { property: [{ role }, each.name] },
      })),
    }));
    const readings = devices.map((device) => ({
      group: device.name,
      inserts: device.properties.map((each): Insert => ({
        label: `${device.name} ${each.name}`,
        value: { property: [device.id, each.name] },
      })),
    }));
    return [{ group: t("message.names"), inserts: names }, ...robots, ...readings].filter(
      (each) => each.inserts.length > 0,
    );
  }, [devices, document, parameters, speaker, t]);
}
