/** Asking people: the question, what may be answered, and where the answer goes. */
import { Select, TagsInput } from "@mantine/core";
import { NumberField } from "@/design/NumberField";
import type { Answer } from "@/program/document/document";
import { useOpenProgram } from "../../state/context";
import { FieldFrame } from "../fields/FieldFrame";
import classes from "../../panel.module.css";
import { MessageField } from "../fields/MessageField";
import { UnitSelect } from "../fields/ParameterCard";
import { useStepEditor } from "../fields/stepEditor";
import { WrittenValue } from "./WrittenValue";
import { VariableField } from "../fields/VariableField";

/** Enter adds one, and the field goes on. */
const SEVERAL = { "data-several": true };
const ANSWERS = ["boolean", "choice", "number", "text"] as const;

export function AskForm() {
  const { t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const answer = (step.params.answer ?? { type: "boolean" }) as Answer;
  return (
    <>
      <MessageField label={t("ask.question")} field="question" placeholder={t("ask.example")} />
      <FieldFrame label={t("ask.answer")} field="answer.type">
        {({ control }) => (
          <Select
            id={control}
            data={ANSWERS.map((type) => ({ value: type, label: t(`ask.${type}`) }))}
            value={answer.type}
            onChange={(type) => set("answer", { type: type ?? "boolean" })}
            allowDeselect={false}
            disabled={disabled}
          />
        )}
      </FieldFrame>
      {answer.type === "choice" ? <Options answer={answer} /> : null}
      {answer.type === "number" ? <Range answer={answer} /> : null}
      <VariableField label={t("ask.variable")} field="variable" optional placeholder={t("ask.no_variable")} />
      <WrittenValue label={t("ask.limit")} field="timeout" wanted="number" placeholder={t("ask.no_limit")} />
      <p className={classes.now}>{t("ask.unit")}</p>
    </>
  );
}

function Options({ answer }: { answer: Answer }) {
  const { t } = useOpenProgram();
  const { set, disabled } = useStepEditor();
  return (
    <FieldFrame label={t("ask.options")} field="answer.options">
      {({ control, note, bad }) => (
        <TagsInput
          wrapperProps={SEVERAL}
          classNames={{ pill: classes.pill }}
          id={control}
          aria-describedby={bad ? note : undefined}
          error={bad}
          value={[...(answer.options ?? [])]}
          placeholder={t("ask.add_option")}
          onChange={(options) => set("answer", { ...answer, options })}
          disabled={disabled}
        />
      )}
    </FieldFrame>
  );
}

function Range({ answer }: { answer: Answer }) {
  const { t } = useOpenProgram();
  const { set, disabled } = useStepEditor();
  const store = (change: Partial<Answer>) => set("answer", withoutNulls({ ...answer, ...change }));
  const end = (name: "minimum" | "maximum") => (
    <NumberField
      aria-label={t(`ask.${name}`)}
      placeholder={t(`ask.${name}`)}
      value={answer[name] ?? ""}
      onChange={(next) => store({ [name]: typeof next === "number" ? next : null })}
      disabled={disabled}
    />
  );
  return (
    <FieldFrame label={t("ask.range")} field="answer.minimum">
      {() => (
        <>
          <div className={classes.pair}>
            {end("minimum")}
            {end("maximum")}
          </div>
          <UnitSelect
            name={t("ask.answer")}
            unit={answer.unit}
            disabled={disabled}
            onUnit={(unit) => store({ unit })}
          />
        </>
      )}
    </FieldFrame>
  );
}

function withoutNulls(answer: Answer): Record<string, unknown> {
  return Object.fromEntries(Object.entries(answer).filter(([, value]) => value !== null && value !== undefined));
}
