/** Forms of the constructs that ask for little: Move, Wait, Parallel, Try. */
import { Button, Checkbox, SegmentedControl } from "@mantine/core";
import { Minus, Plus } from "lucide-react";
import { branchesOf } from "../model/tree";
import type { Place, Value } from "../model/types";
import { useOpenProgram } from "../state/context";
import { ConditionForm } from "./ConditionForm";
import { PlaceField, ValueField } from "./fields";
import classes from "./inspector.module.css";
import { RouteNote } from "./LoadForm";
import { RoleField } from "./RoleField";
import { useStepEditor } from "./stepEditor";

export function MoveForm() {
  const { t } = useOpenProgram();
  const { step, set } = useStepEditor();
  return (
    <>
      <PlaceField
        label={t("field.to")}
        field="to"
        places
        value={(step.params.to as Place) ?? null}
        onChange={(place) => set("to", place)}
      />
      <hr className={classes.line} />
      <RoleField />
      <RouteNote />
    </>
  );
}

export function WaitForm() {
  const { t, apply } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
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
        aria-label={t("wait.mode")}
        data={[
          { value: "time", label: t("wait.time") },
          { value: "until", label: t("wait.until") },
        ]}
      />
      {until ? (
        <>
          <ConditionForm field="until" />
          <ValueField
            label={t("wait.limit")}
            field="timeout"
            unit="s"
            minimum={1}
            value={step.params.timeout as Value}
            onChange={(value) => set("timeout", value)}
            placeholder={t("wait.no_limit")}
          />
        </>
      ) : (
        <ValueField
          label={t("wait.seconds")}
          field="duration"
          unit="s"
          minimum={0}
          value={step.params.duration as Value}
          onChange={(value) => set("duration", value)}
          placeholder={t("wait.example")}
        />
      )}
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
      <p className={classes.now}>{t("parallel.note")}</p>
    </div>
  );
}

const TRY_KINDS = ["refused", "failed", "timed_out", "offline", "blocked", "cancelled"];

export function TryForm() {
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
      <div className={classes.field} style={{ marginTop: 8 }}>
        {TRY_KINDS.map((kind) => (
          <Checkbox key={kind} value={kind} label={t(`try.${kind}`)} disabled={disabled} />
        ))}
      </div>
    </Checkbox.Group>
  );
}
