/** Which robot does it: a role, and whether that is any robot or one by name. */
import { Button, Select } from "@mantine/core";
import { Plus } from "lucide-react";
import type { Device } from "@/api/types";
import { Chip } from "@/design/Chip";
import { makeId } from "../../state/actions";
import { useOpenProgram } from "../../state/context";
import { FieldFrame } from "./FieldFrame";
import classes from "../../panel.module.css";
import { useStepEditor } from "./stepEditor";
import { textOf } from "@/program/document/document";

const ANY = ":any";

export function RoleField() {
  const { document, devices, t } = useOpenProgram();
  const { step } = useStepEditor();
  const role = textOf(step.params.role, "robot");
  const robots = devices.filter((device) => device.kind === "robot" && device.lifecycle === "approved");
  const nameOf = (each: string) => document.roles[each]?.name ?? t("role.default");
  return (
    <>
      <WhichRole role={role} nameOf={nameOf} />
      <WhichRobot role={role} name={nameOf(role)} robots={robots} />
      <div className={classes.robots}>
        {robots.map((robot) => (
          <Chip key={robot.id} tone={robot.status === "offline" ? "plain" : "quiet"}>
            {robot.status === "offline" ? t("role.offline", { robot: robot.name }) : robot.name}
          </Chip>
        ))}
      </div>
    </>
  );
}

function WhichRole({ role, nameOf }: { role: string; nameOf: (role: string) => string }) {
  const { document, apply, t } = useOpenProgram();
  const { id, set, disabled } = useStepEditor();
  const roles = ["robot", ...Object.keys(document.roles).filter((each) => each !== "robot")];
  const add = () => {
    const fresh = makeId();
    apply([
      { do: "set_role", id: fresh, value: { name: t("role.numbered", { number: roles.length + 1 }), can: [] } },
      { do: "set_param", id, name: "role", value: fresh },
    ]);
  };
  return (
    <FieldFrame label={t("role.label")} field="role">
      {({ control }) => (
        <div className={classes.row}>
          <Select
            id={control}
            className={classes.grow}
            data={roles.map((each) => ({ value: each, label: nameOf(each) }))}
            value={role}
            onChange={(next) => set("role", next ?? "robot")}
            allowDeselect={false}
            disabled={disabled}
          />
          <Button
            variant="default"
            px={10}
            onClick={add}
            disabled={disabled}
            aria-label={t("role.add")}
            title={t("role.add")}
          >
            <Plus size={16} aria-hidden="true" />
          </Button>
        </div>
      )}
    </FieldFrame>
  );
}

function WhichRobot({ role, name, robots }: { role: string; name: string; robots: readonly Device[] }) {
  const { document, apply, t } = useOpenProgram();
  const { disabled } = useStepEditor();
  const entry = document.roles[role];
  const bind = (device: string | null) => {
    const value = device && device !== ANY ? { name, device } : { name, can: entry?.can ?? [] };
    apply([{ do: "set_role", id: role, value }]);
  };
  return (
    <FieldFrame label={t("role.who", { role: name })} field={`roles.${role}`}>
      {({ control }) => (
        <Select
          id={control}
          data={[{ value: ANY, label: t("role.any") }, ...robots.map(({ id, name: label }) => ({ value: id, label }))]}
          value={entry?.device ?? ANY}
          onChange={bind}
          allowDeselect={false}
          disabled={disabled}
        />
      )}
    </FieldFrame>
  );
}
