/** The robots of the program: each is one robot by name, or any that can do what is asked. */
import { ActionIcon, Button, MultiSelect, Select } from "@mantine/core";
import { Plus, Trash2 } from "lucide-react";
import { drivenBy } from "../edits/fixes";
import type { ProgramDocument, Role } from "@/program/document/document";
import { makeId } from "../state/actions";
import { useOpenProgram } from "../state/context";
import classes from "../panel.module.css";
import { NamedField } from "./fields/NamedField";
import { RobotChoice } from "./RobotChoice";
import { Section } from "./fields/FieldFrame";

/** A choice adds one, and the list goes on. */
const SEVERAL = { "data-several": true };
const ANY = ":any";
/** The role that every program has. */
const FIRST = "robot";

export function RolesSection() {
  const { t, document, apply, canEdit } = useOpenProgram();
  const others = Object.keys(document.roles).filter((id) => id !== FIRST);
  const first = others.length === 0 || FIRST in document.roles || isUsed(document, FIRST);
  const roles = first ? [FIRST, ...others] : others;
  const add = () =>
    apply([
      { do: "set_role", id: makeId(), value: { name: t("role.numbered", { number: roles.length + 1 }), can: [] } },
    ]);
  return (
    <Section title={t("program.robots")} note={t("program.robots_note")}>
      {roles.map((id) => (
        <RoleCard key={id} id={id} role={document.roles[id] ?? {}} />
      ))}
      <Button
        variant="default"
        size="xs"
        className={classes.between}
        leftSection={<Plus size={14} aria-hidden="true" />}
        disabled={!canEdit}
        onClick={add}
      >
        {t("role.add")}
      </Button>
    </Section>
  );
}

function isUsed(document: ProgramDocument, role: string): boolean {
  return Object.keys(document.steps).some((id) => drivenBy(document, id) === role);
}

function RoleCard({ id, role }: { id: string; role: Role }) {
  const { t, document, apply, canEdit } = useOpenProgram();
  const name = role.name ?? t("role.default");
  const used = isUsed(document, id);
  const store = (value: Role | null) => apply([{ do: "set_role", id, value }]);
  return (
    <div className={classes.comparison} role="group" aria-label={name}>
      <div className={classes.row}>
        <span className={classes.grow}>
          <NamedField
            label={t("role.name")}
            hidden
            value={name}
            disabled={!canEdit}
            onChange={(next) => store({ ...role, name: next })}
          />
        </span>
        {id === FIRST ? null : (
          <ActionIcon
            variant="subtle"
            color="gray"
            size={34}
            aria-label={t("call.remove_parameter", { name })}
            title={used ? t("role.used") : undefined}
            disabled={!canEdit || used}
            onClick={() => store(null)}
          >
            <Trash2 size={15} aria-hidden="true" />
          </ActionIcon>
        )}
      </div>
      <Binding id={id} name={name} role={role} store={store} />
    </div>
  );
}

interface BindingProps {
  readonly id: string;
  readonly name: string;
  readonly role: Role;
  readonly store: (role: Role) => void;
}

function Binding({ id, name, role, store }: BindingProps) {
  const { t, devices, canEdit } = useOpenProgram();
  const robots = devices.filter((device) => device.kind === "robot" && device.lifecycle === "approved");
  const methods = [...new Set(robots.flatMap((robot) => robot.methods.map((each) => each.name)))].sort();
  const choice = role.where === null || role.where === undefined ? {} : { where: role.where };
  const bind = (device: string | null) =>
    store(device && device !== ANY ? { name, device } : { ...choice, name, can: role.can ?? [] });
  return (
    <>
      <Select
        aria-label={t("role.who", { role: name })}
        data={[
          { value: ANY, label: t("role.any") },
          ...robots.map((robot) => ({ value: robot.id, label: robot.name })),
        ]}
        value={role.device ?? ANY}
        onChange={bind}
        allowDeselect={false}
        disabled={!canEdit}
      />
      {role.device ? null : (
        <MultiSelect
          wrapperProps={SEVERAL}
          classNames={{ pill: classes.pill }}
          aria-label={t("role.can", { role: name })}
          placeholder={role.can?.length ? undefined : t("role.can_what_is_needed")}
          data={methods}
          value={[...(role.can ?? [])]}
          onChange={(can) => store({ ...choice, name, can })}
          disabled={!canEdit}
        />
      )}
      {role.device ? null : (
        <RobotChoice
          id={id}
          name={name}
          role={role}
          store={(where) => store({ name, can: role.can ?? [], ...(where === null ? {} : { where }) })}
        />
      )}
    </>
  );
}
