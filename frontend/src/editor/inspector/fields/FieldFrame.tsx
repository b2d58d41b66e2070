/** The inspector's fields: a label, a control, and the problems under it. */
import { CircleAlert, TriangleAlert } from "lucide-react";
import { type FocusEvent, type ReactNode, useId } from "react";
import { useOpenProgram } from "../../state/context";
import classes from "../../panel.module.css";
import { useStepEditor } from "./stepEditor";

/** Errors whose field is this one, or inside it. */
export function useFieldProblems(field: string): readonly string[] {
  return useFieldMessages(field, "error");
}

function useFieldMessages(field: string, severity: "error" | "warning"): readonly string[] {
  const { diagnostics } = useOpenProgram();
  const { id } = useStepEditor();
  return diagnostics
    .filter((each) => each.step === id && each.severity === severity)
    .filter((each) => each.field === field || each.field.startsWith(`${field}.`))
    .map((each) => each.message);
}

export function FieldFrame({
  label,
  field,
  problems,
  children,
}: {
  label: string;
  field: string;
  problems?: readonly string[];
  children: (ids: { control: string; note: string; bad: boolean }) => ReactNode;
}) {
  const control = useId();
  const found = useFieldProblems(field);
  const warnings = useFieldMessages(field, "warning");
  const messages = problems ?? found;
  const { showEditing } = useStepEditor();
  const leave = (event: FocusEvent) => {
    if (!event.currentTarget.contains(event.relatedTarget)) showEditing(false);
  };
  return (
    <div className={classes.field} data-field={field} onFocus={() => showEditing(true)} onBlur={leave}>
      <label htmlFor={control}>{label}</label>
      {children({ control, note: `${control}-note`, bad: messages.length > 0 })}
      {messages.length > 0 ? (
        <p className={classes.problem} id={`${control}-note`}>
          <CircleAlert size={14} aria-hidden="true" />
          <span>{messages.join(" ")}</span>
        </p>
      ) : null}
      {warnings.length > 0 ? (
        <p className={classes.warning}>
          <TriangleAlert size={14} aria-hidden="true" />
          <span>{warnings.join(" ")}</span>
        </p>
      ) : null}
    </div>
  );
}

export function Section({ title, note, children }: { title: string; note?: string; children: ReactNode }) {
  return (
    <section className={classes.section} aria-label={title}>
      <h3>{title}</h3>
      {note ? <p className={classes.now}>{note}</p> : null}
      {children}
    </section>
  );
}
