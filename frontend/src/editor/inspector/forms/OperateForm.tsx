/** Operate: a machine, one of its methods, and what the method wants to know. */
import { Select } from "@mantine/core";
import type { Place, Value } from "@/program/document/document";
import type { MethodParameter } from "@/program/surroundings";
import { methodOf } from "@/program/words/stepWords";
import { operable } from "../../state/tool";
import { useOpenProgram } from "../../state/context";
import { ExpressionField } from "../expression/ExpressionField";
import { FieldFrame } from "../fields/FieldFrame";
import { PlaceField } from "../fields/PlaceField";
import { useStepEditor } from "../fields/stepEditor";

export function OperateForm() {
  const { surroundings } = useOpenProgram();
  const { step } = useStepEditor();
  const { method } = methodOf(step, surroundings);
  return (
    <>
      <MachineField />
      <MethodField />
      {(method?.parameters ?? []).map((parameter) => (
        <ArgumentField key={parameter.name} parameter={parameter} />
      ))}
    </>
  );
}

/** Another machine keeps the method if it has it too, else its only one is taken. */
function MachineField() {
  const { t, surroundings, apply } = useOpenProgram();
  const { id, step } = useStepEditor();
  const choose = (place: Place | null) => {
    const chosen = place && "device" in place ? surroundings.devices.get(place.device) : undefined;
    const methods = chosen ? operable(chosen) : [];
    const keeps = !chosen || methods.some((each) => each.name === step.params.method);
    const only = methods.length === 1 ? methods[0]?.name : null;
    const fresh = [
      { do: "set_param" as const, id, name: "method", value: only },
      { do: "set_param" as const, id, name: "args", value: {} },
    ];
    apply([{ do: "set_param", id, name: "device", value: place }, ...(keeps ? [] : fresh)]);
  };
  return (
    <PlaceField
      label={t("field.machine")}
      field="device"
      value={(step.params.device as Place) ?? null}
      accept={(each) => each.methods.some(({ name }) => name !== "dispense" && name !== "accept")}
      onChange={choose}
    />
  );
}

function MethodField() {
  const { t, surroundings } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const { device } = methodOf(step, surroundings);
  return (
    <FieldFrame label={t("field.method")} field="method">
      {({ control, note, bad }) => (
        <Select
          id={control}
          aria-describedby={bad ? note : undefined}
          error={bad}
          data={(device ? operable(device) : []).map((each) => ({ value: each.name, label: each.title || each.name }))}
          value={typeof step.params.method === "string" ? step.params.method : null}
          onChange={(next) => set("method", next)}
          placeholder={t("field.choose")}
          disabled={disabled || !device}
        />
      )}
    </FieldFrame>
  );
}

function ArgumentField({ parameter }: { parameter: MethodParameter }) {
  const { id, step, set } = useStepEditor();
  const args = (step.params.args ?? {}) as Record<string, Value>;
  const { name, type, unit, minimum, maximum, options } = parameter;
  return (
    <ExpressionField
      label={name}
      step={id}
      field={`args.${name}`}
      wanted={type ?? "text"}
      unit={unit}
      minimum={minimum}
      maximum={maximum}
      options={options}
      value={args[name] ?? null}
      onChange={(value) => set("args", { ...args, [name]: value })}
    />
  );
}
