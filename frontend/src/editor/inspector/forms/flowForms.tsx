/** Loops over items, and what a function gives back. */
import { SegmentedControl, Select } from "@mantine/core";
import { functionOf } from "@/program/scene/stepPaths";
import { useOpenProgram } from "../../state/context";
import { FieldFrame } from "../fields/FieldFrame";
import { ItemsField } from "../fields/ItemsField";
import classes from "../../panel.module.css";
import { useStepEditor } from "../fields/stepEditor";
import { VariableField } from "../fields/VariableField";
import { WrittenValue } from "./WrittenValue";

export function ForEachForm() {
  const { t } = useOpenProgram();
  const { step, set, disabled, parameters } = useStepEditor();
  const lists = parameters.filter((each) => each.type === "list").map((each) => each.name);
  const listed = (step.params.list ?? null) !== null;
  const choose = (mode: string) => set("list", mode === "list" ? (lists[0] ? { param: lists[0] } : {}) : null);
  return (
    <>
      <SegmentedControl
        fullWidth
        value={listed ? "list" : "items"}
        onChange={choose}
        disabled={disabled}
        aria-label={t("for_each.mode")}
        data={[
          { value: "items", label: t("for_each.items_mode") },
          { value: "list", label: t("for_each.list_mode") },
        ]}
      />
      {listed ? <ListField lists={lists} /> : <ItemsField />}
      <VariableField label={t("for_each.variable")} field="variable" />
      <p className={classes.now}>{t("for_each.note")}</p>
      <VariableField label={t("for_each.index")} field="index" optional placeholder={t("for_each.no_index")} />
    </>
  );
}

/** The variable whose list a For-each goes through. */
function ListField({ lists }: { lists: readonly string[] }) {
  const { t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const { list } = step.params;
  const named = typeof list === "object" && list !== null && "param" in list ? String(list.param) : null;
  const names = named !== null && !lists.includes(named) ? [named, ...lists] : [...lists];
  return (
    <FieldFrame label={t("for_each.list")} field="list">
      {({ control, note, bad }) => (
        <>
          <Select
            id={control}
            aria-describedby={bad ? note : undefined}
            error={bad}
            data={names}
            value={named}
            disabled={disabled}
            onChange={(name) => set("list", name === null ? {} : { param: name })}
          />
          {names.length === 0 ? <p className={classes.now}>{t("for_each.no_lists")}</p> : null}
        </>
      )}
    </FieldFrame>
  );
}

export function ReturnForm() {
  const { t, document } = useOpenProgram();
  const { id } = useStepEditor();
  const scope = functionOf(document, id);
  const result = scope ? document.functions[scope]?.result : null;
  if (!scope) return <p className={classes.now}>{t("return.outside")}</p>;
  return (
    <>
      <WrittenValue label={t("return.value")} field="value" wanted={result?.type} />
      <p className={classes.now}>{t(result ? "return.note" : "return.nothing")}</p>
    </>
  );
}
