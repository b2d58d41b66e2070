/** Which robot does it: a role, and whether that is any robot or one by name. */
import { Button, Select } from "@mantine/core";
import { Plus } from "lucide-react";
import { Chip } from "@/design/Chip";
import { makeId } from "../state/actions";
import { useOpenProgram } from "../state/context";
import { FieldFrame } from "./fields";
import classes from "./inspector.module.css";
import { useStepEditor } from "./stepEditor";

const ANY = ":any";

export function RoleField() {
  const { document, devices, apply, t } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const role = String(step.params.role ?? "robot");
  const entry = document.roles[role];
  const robots = devices.filter((device) => device.kind === "robot" && device.lifecycle === "approved");
  const roles = ["robot", ...Object.keys(document.roles).filter((each) => each !== "robot")];
  const nameOf = (each: string) => document.roles[each]?.name ?? t("role.default");
  const bind = (device: string | null) => {
    const name = nameOf(role);
    const value = device && device !== ANY ? { name, device } : { name, can: entry?.can ?? [] };
    apply([{ do: "set_role", id: role, value }]);
  };
  const addRole = () => {
    const fresh = makeId();
    apply([
      { do: "set_role", id: fresh, value: { name: t("role.numbered", { number: roles.length + 1 }), can: [] } },
      { do: "set_param", id, name: "role", value: fresh },
    ]);
  };
  return (
    <>
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
              onClick={addRole}
              disabled={disabled}
              aria-label={t("role.add")}
              title={t("role.add")}
            >
              <Plus size={16} aria-hidden="true" />
            </Button>
          </div>
        )}
      </FieldFrame>
      <FieldFrame label={t("role.who", { role: nameOf(role) })} field={`roles.${role}`}>
        {({ control }) => (
          <Select
            id={control}
            data={[
              { value: ANY, label: t("role.any") },
              ...robots.map((robot) => ({ value: robot.id, label: robot.name })),
            ]}
            value={entry?.device ?? ANY}
            onChange={bind}
            allowDeselect={false}
            disabled={disabled}
          />
        )}
      </FieldFrame>
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
