/** A call: which function, its arguments, where its result goes, and the function itself. */
import { Select } from "@mantine/core";
import { type Parameter, type Place, type Value, textOf } from "@/program/document/document";
import { ownEntry } from "@/design/ownEntry";
import { useOpenProgram } from "../../state/context";
import { ExpressionField } from "../expression/ExpressionField";
import { FieldFrame } from "../fields/FieldFrame";
import { FunctionForm } from "./FunctionForm";
import classes from "../../panel.module.css";
import { PlaceField } from "../fields/PlaceField";
import { useStepEditor } from "../fields/stepEditor";
import { VariableField } from "../fields/VariableField";

export function CallForm() {
  const { t, document } = useOpenProgram();
  const { step } = useStepEditor();
  const functionId = textOf(step.params.function);
  const definition = ownEntry(document.functions, functionId);
  return (
    <>
      <WhichFunction functionId={functionId} />
      {definition ? (
        <>
          {definition.parameters.map((parameter) => (
            <ArgumentField key={parameter.name} parameter={parameter} />
          ))}
          {definition.result ? (
            <VariableField label={t("call.result")} field="result" optional placeholder={t("call.no_result")} />
          ) : null}
          <hr className={classes.line} />
          <FunctionForm functionId={functionId} definition={definition} />
        </>
      ) : (
        <p className={classes.problem}>{t("call.gone")}</p>
      )}
    </>
  );
}

function WhichFunction({ functionId }: { functionId: string }) {
  const { t, document } = useOpenProgram();
  const { set, disabled } = useStepEditor();
  const functions = Object.entries(document.functions);
  return (
    <FieldFrame label={t("call.function")} field="function" problems={[]}>
      {({ control }) => (
        <Select
          id={control}
          data={functions.map(([id, each]) => ({ value: id, label: each.name }))}
          value={Object.hasOwn(document.functions, functionId) ? functionId : null}
          onChange={(next) => set("function", next)}
          placeholder={t("field.choose")}
          allowDeselect={false}
          disabled={disabled}
        />
      )}
    </FieldFrame>
  );
}

function ArgumentField({ parameter }: { parameter: Parameter }) {
  const { t } = useOpenProgram();
  const { id, step, set } = useStepEditor();
  const args = (step.params.args ?? {}) as Record<string, Value | Place>;
  const { name, type } = parameter;
  const give = (value: unknown) => set("args", { ...args, [name]: value });
  if (type === "device" || type === "place")
    return (
      <PlaceField
        label={name}
        field={`args.${name}`}
        places={type === "place"}
        value={(ownEntry(args, name) as Place | undefined) ?? null}
        onChange={give}
      />
    );
  return (
    <ExpressionField
      label={name}
      step={id}
      field={`args.${name}`}
      wanted={type}
      unit={parameter.unit}
      value={ownEntry(args, name) as Value}
      onChange={give}
      placeholder={
        typeof parameter.default === "object" || parameter.default === undefined
          ? undefined
          : t("call.default", { value: String(parameter.default) })
      }
    />
  );
}
