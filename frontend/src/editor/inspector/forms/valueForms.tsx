/** Forms of the constructs that hold a value: Repeat, Set, Return. */
import type { Value } from "@/program/document/document";
import { functionOf } from "@/program/scene/stepPaths";
import { useOpenProgram } from "../../state/context";
import { ExpressionField } from "../expression/ExpressionField";
import classes from "../../panel.module.css";
import { useStepEditor } from "../fields/stepEditor";
import { VariableField } from "../fields/VariableField";

/** One of the step's parameters as a written value. */
export function WrittenValue({
  label,
  field,
  wanted,
  placeholder,
}: {
  label: string;
  field: string;
  wanted?: string;
  placeholder?: string;
}) {
  const { id, step, set } = useStepEditor();
  return (
    <ExpressionField
      step={id}
      label={label}
      field={field}
      wanted={wanted}
      placeholder={placeholder}
      value={step.params[field] as Value | undefined}
      onChange={(value) => set(field, value)}
    />
  );
}

export function RepeatForm() {
  const { t } = useOpenProgram();
  return <WrittenValue label={t("repeat.times")} field="times" wanted="number" placeholder="3" />;
}

export function SetForm() {
  const { t } = useOpenProgram();
  return (
    <>
      <VariableField label={t("set.variable")} field="variable" />
      <WrittenValue label={t("set.value")} field="value" placeholder={t("set.value_example")} />
      <p className={classes.now}>{t("set.note")}</p>
    </>
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

/** What needs no values: one sentence says what it does. */
export function Sentence({ of }: { of: string }) {
  const { t } = useOpenProgram();
  return <p className={classes.now}>{t(`sentence.${of}`)}</p>;
}
