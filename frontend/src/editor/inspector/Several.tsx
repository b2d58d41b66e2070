/** Several selected steps: what all of them are told, with one value for all, and what can be done with them. */
import { Button, Select } from "@mantine/core";
import { X } from "lucide-react";
import { type ReactNode, useMemo } from "react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import type { Place } from "@/program/document/document";
import { type Command, selection } from "../commands/command";
import { runCommand } from "../commands/keys";
import { COMMANDS, commandOf } from "../commands/table";
import { type CommonField, commonFields, setForAll } from "../edits/commonFields";
import { knownNames } from "../edits/variables";
import { useOpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import { FormBody } from "../canvas/FormBody";
import { FieldFrame, Section } from "./fields/FieldFrame";
import { PlaceField } from "./fields/PlaceField";
import { StepEditorContext, type StepEditor } from "./fields/stepEditor";
import { WrittenValue } from "./forms/WrittenValue";
import classes from "../panel.module.css";

const BUTTONS = ["make_function", "limit", "duplicate", "delete"];

export function Several() {
  const { t, canEdit } = useOpenProgram();
  const selected = useUi((ui) => ui.selected);
  return (
    <aside className={classes.panel} aria-label={t("inspector.label")}>
      <header className={classes.head}>
        <span className={classes.title}>
          <h2>{t("inspector.several", { count: selected.length })}</h2>
        </span>
        <IconButton label={t("inspector.close")} onClick={() => select([])}>
          <X size={17} aria-hidden="true" />
        </IconButton>
      </header>
      <FormBody>
        <CommonFields ids={selected} />
        {canEdit ? (
          <>
            <Arranging />
            {BUTTONS.map((id) => (
              <CommandButton key={id} command={commandOf(id)} />
            ))}
          </>
        ) : null}
      </FormBody>
    </aside>
  );
}

/** Absent where it cannot be done with these steps. */
function CommandButton({ command }: { command: Command }) {
  const open = useOpenProgram();
  const { t } = useTranslation();
  const { icon: Icon } = command;
  if (command.whyNot(open, selection()) !== null) return null;
  return (
    <Button
      variant="default"
      c={command.id === "delete" ? "var(--error)" : undefined}
      leftSection={<Icon size={16} />}
      onClick={() => runCommand(open, command)}
    >
      {t(command.words.name)}
    </Button>
  );
}

/** A row of signs: align, distribute, tidy. */
function Arranging() {
  const open = useOpenProgram();
  const { t } = useTranslation();
  return (
    <div role="group" aria-label={t("commands.group.arrange")} className={classes.arranging}>
      {COMMANDS.filter(({ group }) => group === "arrange").map((command) => {
        const { icon: Icon } = command;
        const why = command.whyNot(open, selection());
        return (
          <IconButton
            key={command.id}
            label={why === null ? t(command.words.name) : `${t(command.words.name)}. ${t(why)}`}
            disabled={why !== null}
            onClick={() => runCommand(open, command)}
          >
            <Icon size={17} />
          </IconButton>
        );
      })}
    </div>
  );
}

function CommonFields({ ids }: { ids: readonly string[] }) {
  const { document, apply, canEdit, t } = useOpenProgram();
  const fields = useMemo(() => {
    const steps = ids.flatMap((id) => document.steps[id] ?? []);
    return commonFields(steps).filter(({ field }) => fieldOf(field.type, field.wanted) !== null);
  }, [document, ids]);
  const editor = useMemo<StepEditor | null>(() => {
    const [first = ""] = ids;
    const step = document.steps[first];
    if (!step) return null;
    const common = Object.fromEntries(fields.map(({ field, value }) => [field.name, value]));
    return {
      // No step's own: what is wrong with one of them is shown where it is selected alone.
      id: "",
      step: { ...step, params: common },
      parameters: knownNames(document, first),
      disabled: !canEdit,
      set: (name, value) => apply(setForAll(ids, name, value)),
      showEditing: () => undefined,
    };
  }, [document, ids, fields, canEdit, apply]);
  if (!editor || fields.length === 0) return null;
  return (
    <StepEditorContext value={editor}>
      <Section title={t("inspector.in_common")}>
        {fields.map((common) => (
          <Common key={common.field.name} common={common} editor={editor} />
        ))}
      </Section>
    </StepEditorContext>
  );
}

interface CommonProps {
  common: CommonField;
  editor: StepEditor;
}

function Common({ common, editor }: CommonProps) {
  const Shown = fieldOf(common.field.type, common.field.wanted);
  return Shown ? <Shown common={common} editor={editor} /> : null;
}

/** What has a field for several steps; conditions, messages and methods are each step's own. */
function fieldOf(type: string, wanted: string | undefined): ((props: CommonProps) => ReactNode) | null {
  if (type === "value") return wanted === "boolean" || wanted === "text" ? null : CommonValue;
  return { role: CommonRole, place: CommonPlace, choice: CommonChoice, zone: CommonZone }[type] ?? null;
}

function useLabel({ field: { name } }: CommonField, kind: string): string {
  const { t } = useOpenProgram();
  const usual = { role: "role.label", at: "field.place", source: "field.pick_from", target: "field.drop_at" }[name];
  return t(`form.${kind}.${name}`, { defaultValue: t(usual ?? `field.${name}`) });
}

function useMixed({ mixed }: CommonField): string | undefined {
  const { t } = useOpenProgram();
  return mixed ? t("inspector.mixed") : undefined;
}

function CommonValue({ common, editor }: CommonProps) {
  const { name, wanted } = common.field;
  const kind = wanted === "time" || wanted === "length" ? "number" : wanted;
  const label = useLabel(common, editor.step.kind);
  return <WrittenValue label={label} field={name} wanted={kind} placeholder={useMixed(common)} />;
}

function CommonPlace({ common, editor }: CommonProps) {
  const { name, accepts } = common.field;
  return (
    <PlaceField
      label={useLabel(common, editor.step.kind)}
      field={name}
      places={!accepts}
      placeholder={useMixed(common)}
      value={(common.value ?? null) as Place | null}
      onChange={(place) => editor.set(name, place)}
    />
  );
}

function CommonRole(props: CommonProps) {
  const { document, t } = useOpenProgram();
  const roles = ["robot", ...Object.keys(document.roles).filter((each) => each !== "robot")];
  const data = roles.map((value) => ({ value, label: document.roles[value]?.name ?? t("role.default") }));
  return <CommonSelect {...props} data={data} usual="robot" />;
}

function CommonZone(props: CommonProps) {
  const { document } = useOpenProgram();
  return (
    <CommonSelect
      {...props}
      data={Object.entries(document.zones).map(([value, { name }]) => ({ value, label: name }))}
    />
  );
}

function CommonChoice(props: CommonProps) {
  const { t } = useOpenProgram();
  const { choices = [] } = props.common.field;
  const data = choices.map((value) => ({ value, label: t(`form.${props.editor.step.kind}.${value}`) }));
  return <CommonSelect {...props} data={data} usual={choices[0]} />;
}

interface CommonSelectProps extends CommonProps {
  data: { value: string; label: string }[];
  /** What is meant where nothing is given. */
  usual?: string;
}

function CommonSelect({ common, editor, data, usual }: CommonSelectProps) {
  const { name } = common.field;
  const given = typeof common.value === "string" ? common.value : (usual ?? null);
  const label = useLabel(common, editor.step.kind);
  const placeholder = useMixed(common);
  return (
    <FieldFrame label={label} field={name}>
      {({ control }) => (
        <Select
          id={control}
          data={data}
          value={common.mixed ? null : given}
          placeholder={placeholder}
          allowDeselect={false}
          disabled={editor.disabled}
          onChange={(next) => editor.set(name, next)}
        />
      )}
    </FieldFrame>
  );
}
