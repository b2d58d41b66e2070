/** A value written as one line: what the script has, without `self.`, and `10 min` for a quantity. */
import { ExpressionInput } from "./ExpressionInput";
import { FieldFrame, useFieldProblems } from "../fields/FieldFrame";
import type { Value } from "@/program/document/document";
import { type Translate, withUnit } from "@/program/words/stepWords";
import { unitSign } from "@/i18n/units";
import { useOpenProgram } from "../../state/context";
import { Readings } from "./Readings";
import { useExpression } from "./useExpression";
import { useWanted } from "./useWanted";

export interface ExpressionFieldProps {
  readonly value: Value | undefined;
  readonly onChange: (value: Value) => void;
  /** The step whose names can be seen. */
  readonly step: string;
  readonly field: string;
  readonly label: string;
  /** The type that is wanted, when it matters: number, text, boolean, object. */
  readonly wanted?: string;
  /** What a bare number is in. */
  readonly unit?: string | null;
  readonly minimum?: number | null;
  readonly maximum?: number | null;
  /** What can be chosen. */
  readonly options?: readonly unknown[] | null;
  readonly placeholder?: string;
}

export function ExpressionField(props: ExpressionFieldProps) {
  const { value, onChange, step, field, label } = props;
  const { t } = useOpenProgram();
  const wanted = useWanted(props.wanted, props.options);
  const expression = useExpression({ value, onChange, step, wanted });
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
            wanted={wanted}
            unit={unitSign(props.unit)}
            placeholder={props.placeholder ?? rangeText(props, t)}
          />
          <Readings value={value} />
        </>
      )}
    </FieldFrame>
  );
}

/** "Between 1 and 10 min", as far as it is known: in words, since a number alone looks like a value. */
function rangeText({ minimum, maximum, unit }: ExpressionFieldProps, t: Translate): string | undefined {
  if (typeof minimum !== "number" || typeof maximum !== "number") return undefined;
  return t("field.between", { minimum, maximum: withUnit(String(maximum), unit) });
}
