/** Forms of the constructs whose fields depend on each other: Wait, Parallel. */
import { Button, SegmentedControl } from "@mantine/core";
import { Minus, Plus } from "lucide-react";
import { NumberField } from "@/design/NumberField";
import { branchesOf } from "@/program/document/tree";
import { type Ending, endingOf } from "@/program/words/parallelWords";
import { useOpenProgram } from "../../state/context";
import { ConditionForm } from "./ConditionForm";
import { StepField } from "./ConstructForm";
import classes from "../../panel.module.css";
import { FieldFrame } from "../fields/FieldFrame";
import { useStepEditor } from "../fields/stepEditor";

export function WaitForm() {
  const { t, apply } = useOpenProgram();
  const { id, step, disabled } = useStepEditor();
  const until = "until" in step.params;
  const choose = (mode: string) =>
    apply(
      mode === "until"
        ? [
            { do: "set_param", id, name: "duration", value: null },
            { do: "set_param", id, name: "until", value: { op: "<", args: [null, null] } },
          ]
        : [
            { do: "set_param", id, name: "until", value: null },
            { do: "set_param", id, name: "timeout", value: null },
          ],
    );
  return (
    <>
      <SegmentedControl
        fullWidth
        value={until ? "until" : "time"}
        onChange={choose}
        disabled={disabled}
        aria-label={t("form.wait.mode")}
        data={[
          { value: "time", label: t("form.wait.duration_mode") },
          { value: "until", label: t("form.wait.until_mode") },
        ]}
      />
      {until ? (
        <>
          <ConditionForm field="until" />
          <StepField name="timeout" />
        </>
      ) : (
        <StepField name="duration" />
      )}
      <p className={classes.now}>{t("form.wait.note")}</p>
    </>
  );
}

const LETTERS = "abcdefgh";

export function ParallelForm() {
  const { t, scene } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const branches = branchesOf(step);
  const last = branches.at(-1) ?? "b";
  const next = LETTERS[branches.length];
  return (
    <>
      <div className={classes.field}>
        <span className={classes.legend}>{t("parallel.branches", { names: branches.join(", ") })}</span>
        <div className={classes.row}>
          <Button
            variant="default"
            leftSection={<Plus size={15} aria-hidden="true" />}
            disabled={disabled || !next}
            onClick={() => set("branches", [...branches, next])}
          >
            {t("parallel.add")}
          </Button>
          <Button
            variant="default"
            leftSection={<Minus size={15} aria-hidden="true" />}
            disabled={disabled || branches.length <= 2 || scene.tree.children(id, last).length > 0}
            onClick={() => set("branches", branches.slice(0, -1))}
          >
            {t("parallel.remove", { name: last })}
          </Button>
        </div>
      </div>
      <EndsWith count={branches.length} />
      <p className={classes.now}>{t(`parallel.note_${endingOf(step)}`)}</p>
    </>
  );
}

/** With how many of its branches a Parallel ends: all, the first, or so many. */
function EndsWith({ count }: { count: number }) {
  const { t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const ending = endingOf(step);
  const { needed } = step.params;
  const choices: readonly Ending[] = count > 2 || ending === "some" ? ["all", "first", "some"] : ["all", "first"];
  const chosen: Readonly<Record<Ending, number | null>> = { all: null, first: 1, some: Math.min(2, count) };
  return (
    <FieldFrame label={t("parallel.ends")} field="needed">
      {({ control, note, bad }) => (
        <>
          <SegmentedControl
            id={control}
            fullWidth
            aria-label={t("parallel.ends")}
            value={ending}
            onChange={(next) => set("needed", chosen[next])}
            disabled={disabled}
            data={choices.map((choice) => ({ value: choice, label: t(`parallel.ends_${choice}`) }))}
          />
          {ending === "some" ? (
            <NumberField
              aria-label={t("parallel.number")}
              aria-describedby={bad ? note : undefined}
              error={bad}
              value={typeof needed === "number" ? needed : ""}
              onChange={(next) => set("needed", typeof next === "number" ? next : null)}
              min={1}
              max={count}
              allowDecimal={false}
              suffix={t("parallel.of", { count })}
              disabled={disabled}
            />
          ) : null}
        </>
      )}
    </FieldFrame>
  );
}
