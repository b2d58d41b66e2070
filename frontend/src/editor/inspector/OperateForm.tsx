/** Operate: a machine, one of its methods, and what the method wants to know. */
import { Select } from "@mantine/core";
import type { Place, Value } from "../model/types";
import { withUnit, methodOf, unitText } from "../scene/words";
import { operable } from "../state/tool";
import { useOpenProgram } from "../state/context";
import { FieldFrame, PlaceField, ValueField } from "./fields";
import { useStepEditor } from "./stepEditor";

export function OperateForm() {
  const { t, surroundings, apply } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const { device, method } = methodOf(step, surroundings);
  const args = (step.params.args ?? {}) as Record<string, Value>;
  const chooseDevice = (place: Place | null) => {
    const chosen = place && "device" in place ? surroundings.devices.get(place.device) : undefined;
    const methods = chosen ? operable(chosen) : [];
    const keeps = methods.some((each) => each.name === step.params.method);
    apply([
      { do: "set_param", id, name: "device", value: place },
      ...(keeps || !chosen
        ? []
        : [
            { do: "set_param" as const, id, name: "method", value: methods.length === 1 ? methods[0]?.name : null },
            { do: "set_param" as const, id, name: "args", value: {} },
          ]),
    ]);
  };
  return (
    <>
      <PlaceField
        label={t("field.machine")}
        field="device"
        value={(step.params.device as Place) ?? null}
        accept={(each) => each.methods.some(({ name }) => name !== "dispense" && name !== "accept")}
        onChange={chooseDevice}
      />
      <FieldFrame label={t("field.method")} field="method">
        {({ control, note, bad }) => (
          <Select
            id={control}
            aria-describedby={bad ? note : undefined}
            error={bad}
            data={(device ? operable(device) : []).map((each) => ({
              value: each.name,
              label: each.title || each.name,
            }))}
            value={typeof step.params.method === "string" ? step.params.method : null}
            onChange={(next) => set("method", next)}
            placeholder={t("field.choose")}
            disabled={disabled || !device}
          />
        )}
      </FieldFrame>
      {(method?.parameters ?? []).map((parameter) => (
        <ValueField
          key={parameter.name}
          label={parameter.name}
          field={`args.${parameter.name}`}
          type={parameter.type ?? "text"}
          unit={parameter.unit}
          minimum={parameter.minimum}
          maximum={parameter.maximum}
          options={parameter.options}
          placeholder={rangeText(parameter)}
          value={args[parameter.name] ?? null}
          onChange={(value) => set("args", { ...args, [parameter.name]: value })}
        />
      ))}
    </>
  );
}

function rangeText(parameter: { minimum?: number | null; maximum?: number | null; unit?: string | null }): string {
  const { minimum, maximum, unit } = parameter;
  if (typeof minimum !== "number" || typeof maximum !== "number") return unitText(unit);
  return withUnit(`${minimum} – ${maximum}`, unit);
}
