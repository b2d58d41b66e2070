/** Pick, Drop and Pick-and-Drop: where, what, how many, who. */
import { ArrowDownUp } from "lucide-react";
import { ActionIcon } from "@mantine/core";
import type { Place, Value } from "@/program/document/document";
import { useOpenProgram } from "../../state/context";
import { ExpressionField } from "../expression/ExpressionField";
import classes from "../../panel.module.css";
import { PlaceField } from "../fields/PlaceField";
import { RoleField } from "../fields/RoleField";
import { RouteField } from "../fields/RouteField";
import { useStepEditor } from "../fields/stepEditor";

export function LoadForm() {
  const { step } = useStepEditor();
  return (
    <>
      {step.kind === "pick_and_drop" ? <BothEnds /> : <OneEnd />}
      <Load />
      <hr className={classes.line} />
      <RoleField />
      <RouteField />
    </>
  );
}

function OneEnd() {
  const { step } = useStepEditor();
  return step.kind === "drop" ? <DropAt field="at" /> : <PickFrom field="at" />;
}

function BothEnds() {
  return (
    <>
      <PickFrom field="source" />
      <SwapEnds />
      <DropAt field="target" />
    </>
  );
}

function PickFrom({ field }: { field: string }) {
  const { t } = useOpenProgram();
  const { step, set } = useStepEditor();
  return (
    <PlaceField
      label={t("field.pick_from")}
      field={field}
      value={(step.params[field] as Place) ?? null}
      accept={(device) => device.gives.length > 0}
      onChange={(place) => set(field, place)}
    />
  );
}

function DropAt({ field }: { field: string }) {
  const { t } = useOpenProgram();
  const { step, set } = useStepEditor();
  return (
    <PlaceField
      label={t("field.drop_at")}
      field={field}
      value={(step.params[field] as Place) ?? null}
      accept={(device) => device.takes.length > 0}
      onChange={(place) => set(field, place)}
    />
  );
}

function SwapEnds() {
  const { t, apply } = useOpenProgram();
  const { id, step, disabled } = useStepEditor();
  const swap = () =>
    apply([
      { do: "set_param", id, name: "source", value: step.params.target },
      { do: "set_param", id, name: "target", value: step.params.source },
    ]);
  return (
    <ActionIcon
      variant="default"
      radius="xl"
      size={28}
      ml="auto"
      my={-6}
      aria-label={t("field.swap")}
      title={t("field.swap")}
      onClick={swap}
      disabled={disabled}
    >
      <ArrowDownUp size={14} aria-hidden="true" />
    </ActionIcon>
  );
}

function Load() {
  const { t, devices } = useOpenProgram();
  const { id, step, set } = useStepEditor();
  const objects = [...new Set(devices.flatMap((device) => [...device.gives, ...device.takes]))].sort();
  const most = Math.max(1, ...devices.map((device) => (device.kind === "robot" ? device.capacity : 1)));
  return (
    <div className={classes.pair}>
      <ExpressionField
        label={t("field.quantity")}
        step={id}
        field="quantity"
        wanted="number"
        value={step.params.quantity as Value}
        onChange={(value) => set("quantity", value)}
        placeholder={most > 1 ? t("field.up_to", { most }) : t("field.example", { value: "1" })}
      />
      <ExpressionField
        label={t("field.object")}
        step={id}
        field="object"
        wanted="object"
        options={objects}
        value={step.params.object as Value}
        onChange={(value) => set("object", value)}
        placeholder={t("field.choose")}
      />
    </div>
  );
}
