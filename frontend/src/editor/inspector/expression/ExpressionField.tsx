/** A value written as one line: what the script has, without `self.`, and `10 min` for a quantity. */
import { ExpressionInput } from "./ExpressionInput";
import { FieldFrame, useFieldProblems } from "../fields";
import type { Value } from "../../model/types";
import { Readings } from "./Readings";
import { useExpression } from "./useExpression";

export interface ExpressionFieldProps {
  readonly value: Value | undefined;
  readonly onChange: (value: Value) => void;
  /** The step whose names can be seen. */
  readonly step: string;
  readonly field: string;
  readonly label: string;
  /** The type that is wanted, when it matters: number, text or boolean. */
  readonly wanted?: string;
  readonly placeholder?: string;
}

export function ExpressionField(props: ExpressionFieldProps) {
  const { value, onChange, step, field, label } = props;
  const expression = useExpression({ value, onChange, step });
  const found = useFieldProblems(field);
  const problems = expression.problem ? [expression.problem] : found;
  return (
    <FieldFrame label={label} field={field} problems={problems}>
      {({ control, note, bad }) => (
        <>
          <ExpressionInput
            id={control}
            note={bad ? note : undefined}
            bad={bad}
            expression={expression}
            placeholder={props.placeholder}
          />
          <Readings value={value} />
        </>
      )}
    </FieldFrame>
  );
}
