/** The text box of an expression. */
import { TextInput } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { useStepEditor } from "../stepEditor";
import type { Expression } from "./useExpression";
import classes from "./expression.module.css";

export function ExpressionInput({
  id,
  note,
  bad,
  expression,
  placeholder,
}: {
  id: string;
  note: string | undefined;
  bad: boolean;
  expression: Expression;
  placeholder?: string;
}) {
  const { t } = useTranslation();
  const { disabled } = useStepEditor();
  return (
    <TextInput
      id={id}
      aria-describedby={note}
      aria-invalid={bad}
      error={bad}
      classNames={{ input: classes.input }}
      disabled={disabled}
      placeholder={placeholder ?? t("expression.placeholder")}
      spellCheck={false}
      autoComplete="off"
      value={expression.text}
      onChange={(event) => expression.write(event.currentTarget.value)}
      onBlur={expression.settle}
    />
  );
}
