/** Operate: a machine or a robot, one of its methods, and what the method wants to know. */
import { Select } from "@mantine/core";
import type { Place, Value } from "@/program/document/document";
import { choices, DEFAULT_ROLE, methodOf, operable, operated, operatedRole } from "@/program/operation";
import type { MethodParameter } from "@/program/surroundings";
import { roleName } from "@/program/words/stepWords";
import { ownEntry } from "@/design/ownEntry";
import { useOpenProgram } from "../../state/context";
import { ExpressionField } from "../expression/ExpressionField";
import { FieldFrame } from "../fields/FieldFrame";
import { PlaceField, type PlaceOption } from "../fields/PlaceField";
import { useStepEditor } from "../fields/stepEditor";

export function OperateForm() {
  const { surroundings, document } = useOpenProgram();
  const { step } = useStepEditor();
  const { method } = methodOf(step, surroundings, document);
  return (
    <>
      <DeviceField />
      <MethodField />
      {(method?.parameters ?? []).map((parameter) => (
        <ArgumentField key={parameter.name} parameter={parameter} />
      ))}
    </>
  );
}

/** Another device keeps the method if it has it too, else its only one is taken. */
function DeviceField() {
  const { t, surroundings, document, apply } = useOpenProgram();
  const { id, step } = useStepEditor();
  const robots = useRobots();
  const role = operatedRole(step.params.device);
  const choose = (device: Place | { role: string } | null) => {
    const chosen = operated(device, document, surroundings);
    const methods = choices(chosen);
    const keeps = chosen.length === 0 || methods.some((each) => each.name === step.params.method);
    const only = methods.length === 1 ? methods[0]?.name : null;
    const fresh = [
      { do: "set_param" as const, id, name: "method", value: only },
      { do: "set_param" as const, id, name: "args", value: {} },
    ];
    apply([{ do: "set_param", id, name: "device", value: device }, ...(keeps ? [] : fresh)]);
  };
  return (
    <PlaceField
      label={t("field.operated")}
      field="device"
      value={role === null ? ((step.params.device as Place) ?? null) : null}
      accept={(each) => each.methods.some(({ name }) => name !== "dispense" && name !== "accept")}
      onChange={choose}
      robots={robots}
      role={role}
      onRole={(next) => choose({ role: next })}
    />
  );
}

/** The program's robots by what they are called there, then those of the site. */
function useRobots(): readonly PlaceOption[] {
  const { t, document, surroundings, devices, speaker } = useOpenProgram();
  const roles = [DEFAULT_ROLE, ...Object.keys(document.roles).filter((each) => each !== DEFAULT_ROLE)];
  const asRoles = roles.map((role) => {
    const bound = document.roles[role]?.device;
    const who = bound ? (surroundings.devices.get(bound)?.name ?? bound) : t("role.any");
    return { value: `role:${role}`, label: t("field.role_who", { role: roleName(role, speaker), who }) };
  });
  const robots = devices.filter((device) => device.kind === "robot" && device.lifecycle !== "pending");
  const byName = robots.map((robot) => ({
    value: `device:${robot.id}`,
    label: robot.name,
    disabled: operable(robot).length === 0,
  }));
  return [...asRoles, ...byName];
}

function MethodField() {
  const { t, surroundings, document } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const devices = operated(step.params.device, document, surroundings);
  return (
    <FieldFrame label={t("field.method")} field="method">
      {({ control, note, bad }) => (
        <Select
          id={control}
          aria-describedby={bad ? note : undefined}
          error={bad}
          data={choices(devices).map((each) => ({ value: each.name, label: each.title || each.name }))}
          value={typeof step.params.method === "string" ? step.params.method : null}
          onChange={(next) => set("method", next)}
          placeholder={t("field.choose")}
          disabled={disabled || devices.length === 0}
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
      value={ownEntry(args, name) ?? null}
      onChange={(value) => set("args", { ...args, [name]: value })}
    />
  );
}
