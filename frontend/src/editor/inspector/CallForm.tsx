/** A call: its arguments, and the function itself with its parameters. */
import { ActionIcon, Button, Select, TextInput } from "@mantine/core";
import { Library, Plus, Trash2 } from "lucide-react";
import { useEffect, useState } from "react";
import type { FunctionDefinition, Parameter, Place, Value } from "../model/types";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { PlaceField, ValueField } from "./fields";
import classes from "./inspector.module.css";
import { useStepEditor } from "./stepEditor";

const TYPES = ["number", "text", "boolean", "object", "device", "place"];

export function CallForm() {
  const { t, document } = useOpenProgram();
  const { step, set } = useStepEditor();
  const functionId = String(step.params.function ?? "");
  const definition = document.functions[functionId];
  const args = (step.params.args ?? {}) as Record<string, Value | Place>;
  if (!definition) return <p className={classes.problem}>{t("call.gone")}</p>;
  const give = (name: string, value: unknown) => set("args", { ...args, [name]: value });
  return (
    <>
      {definition.parameters.map((parameter) =>
        isPlace(parameter.type) ? (
          <PlaceField
            key={parameter.name}
            label={parameter.name}
            field={`args.${parameter.name}`}
            places={parameter.type === "place"}
            value={(args[parameter.name] as Place) ?? null}
            onChange={(place) => give(parameter.name, place)}
          />
        ) : (
          <ValueField
            key={parameter.name}
            label={parameter.name}
            field={`args.${parameter.name}`}
            type={parameter.type}
            unit={parameter.unit}
            options={parameter.type === "boolean" ? ["true", "false"] : null}
            value={args[parameter.name] as Value}
            onChange={(value) => give(parameter.name, value)}
            placeholder={parameter.default === undefined ? undefined : String(parameter.default)}
          />
        ),
      )}
      <hr className={classes.line} />
      <FunctionForm functionId={functionId} definition={definition} />
    </>
  );
}

function isPlace(type: string): boolean {
  return type === "device" || type === "place";
}

function FunctionForm({ functionId, definition }: { functionId: string; definition: FunctionDefinition }) {
  const { t, apply } = useOpenProgram();
  const { disabled } = useStepEditor();
  const store = (change: Partial<FunctionDefinition>) =>
    apply([{ do: "set_function", id: functionId, value: { ...definition, ...change } }]);
  const names = definition.parameters.map((each) => each.name);
  const fresh = [1, 2, 3, 4, 5, 6, 7, 8, 9]
    .map((count) => t("call.fresh", { count }))
    .find((name) => !names.includes(name));
  return (
    <>
      <Named label={t("call.name")} value={definition.name} disabled={disabled} onChange={(name) => store({ name })} />
      {definition.source ? (
        <p className={classes.now}>{t("call.from_library", { version: definition.source.version })}</p>
      ) : null}
      <div className={classes.field}>
        <span className={classes.legend}>{t("call.parameters")}</span>
        {definition.parameters.map((parameter, index) => (
          <ParameterRow
            key={index}
            parameter={parameter}
            onChange={(next) =>
              store({ parameters: definition.parameters.map((each, at) => (at === index ? next : each)) })
            }
            onRemove={() => store({ parameters: definition.parameters.filter((_, at) => at !== index) })}
          />
        ))}
        <Button
          variant="default"
          size="xs"
          className={classes.between}
          leftSection={<Plus size={14} aria-hidden="true" />}
          disabled={disabled || !fresh}
          onClick={() =>
            store({ parameters: [...definition.parameters, { name: fresh ?? "", type: "number", unit: "" }] })
          }
        >
          {t("call.add_parameter")}
        </Button>
      </div>
      <Button
        variant="default"
        leftSection={<Library size={15} aria-hidden="true" />}
        disabled={disabled}
        onClick={() => useUi.setState({ dialog: "save_function", dialogFunction: functionId })}
      >
        {t("call.save")}
      </Button>
    </>
  );
}

function ParameterRow({
  parameter,
  onChange,
  onRemove,
}: {
  parameter: Parameter;
  onChange: (parameter: Parameter) => void;
  onRemove: () => void;
}) {
  const { t } = useOpenProgram();
  const { disabled } = useStepEditor();
  return (
    <div className={classes.parameter}>
      <Named
        label={t("call.parameter_name")}
        hidden
        value={parameter.name}
        disabled={disabled}
        onChange={(name) => onChange({ ...parameter, name: name.replace(/\W/g, "_") })}
      />
      <Select
        aria-label={t("call.parameter_type", { name: parameter.name })}
        data={TYPES.map((type) => ({ value: type, label: t(`type.${type}`) }))}
        value={parameter.type}
        onChange={(type) => onChange({ ...parameter, type: type ?? "number" })}
        allowDeselect={false}
        disabled={disabled}
      />
      <ActionIcon
        variant="subtle"
        color="gray"
        size={30}
        aria-label={t("call.remove_parameter", { name: parameter.name })}
        onClick={onRemove}
        disabled={disabled}
      >
        <Trash2 size={15} aria-hidden="true" />
      </ActionIcon>
    </div>
  );
}

/** A text that is kept when the field is left, not at each letter. */
function Named({
  label,
  value,
  hidden = false,
  disabled,
  onChange,
}: {
  label: string;
  value: string;
  hidden?: boolean;
  disabled: boolean;
  onChange: (value: string) => void;
}) {
  const [text, setText] = useState(value);
  useEffect(() => setText(value), [value]);
  return (
    <TextInput
      label={hidden ? undefined : label}
      aria-label={hidden ? label : undefined}
      value={text}
      disabled={disabled}
      onChange={(event) => setText(event.currentTarget.value)}
      onBlur={() => {
        const next = text.trim();
        if (next && next !== value) onChange(next);
        else setText(value);
      }}
      onKeyDown={(event) => {
        if (event.key === "Enter") event.currentTarget.blur();
      }}
    />
  );
}
