/** One of several fixed words: side by side, or below each other where each needs a sentence. */
import { Radio, SegmentedControl } from "@mantine/core";
import { useOpenProgram } from "../../state/context";
import classes from "../../panel.module.css";
import { FieldFrame } from "./FieldFrame";
import { useStepEditor } from "./stepEditor";

interface ChoiceFieldProps {
  label: string;
  field: string;
  choices: readonly string[];
  /** Where the words of the choices stand in the catalogue. */
  words: string;
  explained?: boolean;
}

export function ChoiceField({ label, field, choices, words, explained = false }: ChoiceFieldProps) {
  const { t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const given = step.params[field];
  const value = choices.find((choice) => choice === given) ?? choices[0];
  if (explained)
    return (
      <Radio.Group label={label} value={value} onChange={(next) => set(field, next)}>
        <div className={classes.choices}>
          {choices.map((choice) => (
            <Radio
              key={choice}
              value={choice}
              label={t(`${words}.${choice}`)}
              description={t(`${words}.${choice}_means`)}
              disabled={disabled}
            />
          ))}
        </div>
      </Radio.Group>
    );
  return (
    <FieldFrame label={label} field={field}>
      {({ control }) => (
        <SegmentedControl
          id={control}
          fullWidth
          aria-label={label}
          value={value}
          onChange={(next) => set(field, next)}
          disabled={disabled}
          data={choices.map((choice) => ({ value: choice, label: t(`${words}.${choice}`) }))}
        />
      )}
    </FieldFrame>
  );
}
