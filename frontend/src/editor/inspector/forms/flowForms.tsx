/** Loops over items, events, and what a Try catches. */
import { Checkbox, Radio, Switch, Textarea } from "@mantine/core";
import { useEffect, useState } from "react";
import { useOpenProgram } from "../../state/context";
import { ConditionForm } from "./ConditionForm";
import { FieldFrame } from "../fields/FieldFrame";
import { ItemsField } from "../fields/ItemsField";
import classes from "../../panel.module.css";
import { useStepEditor } from "../fields/stepEditor";
import { VariableField } from "../fields/VariableField";

export function ForEachForm() {
  const { t } = useOpenProgram();
  return (
    <>
      <ItemsField />
      <VariableField label={t("for_each.variable")} field="variable" />
      <p className={classes.now}>{t("for_each.note")}</p>
    </>
  );
}

export function EventForm() {
  const { t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  return (
    <>
      <ConditionForm field="condition" />
      <Radio.Group
        label={t("event.starts")}
        value={step.params.starts === "run" ? "run" : "branch"}
        onChange={(starts) => set("starts", starts)}
      >
        <div className={classes.choices}>
          {["branch", "run"].map((starts) => (
            <Radio
              key={starts}
              value={starts}
              label={t(`event.${starts}`)}
              description={t(`event.${starts}_means`)}
              disabled={disabled}
            />
          ))}
        </div>
      </Radio.Group>
    </>
  );
}

const TRY_KINDS = ["refused", "failed", "timed_out", "offline", "blocked", "cancelled"];

export function TryForm() {
  const { t, scene } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const inside = (branch: string) => scene.tree.children(id, branch).length > 0;
  const catches = step.params.catch !== false;
  const final = step.params.finally === true || inside("finally");
  return (
    <>
      <Switch
        label={t("try.catches")}
        description={catches && inside("catch") ? t("try.empty_first") : undefined}
        checked={catches}
        disabled={disabled || (catches && inside("catch"))}
        onChange={(event) => set("catch", event.currentTarget.checked ? null : false)}
      />
      {catches ? <Kinds /> : <p className={classes.now}>{t("try.goes_on")}</p>}
      <hr className={classes.line} />
      <Switch
        label={t("try.finally")}
        description={t(inside("finally") ? "try.empty_first" : "try.finally_means")}
        checked={final}
        disabled={disabled || inside("finally")}
        onChange={(event) => set("finally", event.currentTarget.checked || null)}
      />
    </>
  );
}

function Kinds() {
  const { t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const kinds = Array.isArray(step.params.kinds) ? step.params.kinds.map(String) : [];
  return (
    <Checkbox.Group
      label={t("try.label")}
      description={kinds.length === 0 ? t("try.any") : undefined}
      value={kinds}
      onChange={(next) =>
        set(
          "kinds",
          TRY_KINDS.filter((kind) => next.includes(kind)),
        )
      }
    >
      <div className={classes.choices}>
        {TRY_KINDS.map((kind) => (
          <Checkbox key={kind} value={kind} label={t(`try.${kind}`)} disabled={disabled} />
        ))}
      </div>
    </Checkbox.Group>
  );
}

export function CommentForm() {
  const { t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const stored = typeof step.params.text === "string" ? step.params.text : "";
  const [text, setText] = useState(stored);
  useEffect(() => setText(stored), [stored]);
  return (
    <FieldFrame label={t("comment.text")} field="text">
      {({ control }) => (
        <Textarea
          id={control}
          autosize
          minRows={3}
          maxRows={12}
          value={text}
          placeholder={t("comment.example")}
          disabled={disabled}
          onChange={(event) => setText(event.currentTarget.value)}
          onBlur={() => (text === stored ? undefined : set("text", text))}
        />
      )}
    </FieldFrame>
  );
}
