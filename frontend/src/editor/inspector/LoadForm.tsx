/** Pick, Drop and Pick-and-Drop: where, what, how many, who. */
import { ArrowDownUp } from "lucide-react";
import { ActionIcon } from "@mantine/core";
import { VipoIcon } from "@/map/VipoIcon";
import type { Place, Value } from "../model/types";
import { waysOf } from "../scene/routing";
import { durationText } from "../scene/words";
import { knownRoute } from "../canvas/useRoutes";
import { RouteChoice } from "../gestures/RouteChoice";
import { drawnRoute } from "../model/drawnRoute";
import { useOpenProgram } from "../state/context";
import { PlaceField, ValueField } from "./fields";
import classes from "./inspector.module.css";
import { RoleField } from "./RoleField";
import { useStepEditor } from "./stepEditor";

export function LoadForm() {
  const { t, devices, apply } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const objects = [...new Set(devices.flatMap((device) => [...device.gives, ...device.takes]))].sort();
  const most = Math.max(1, ...devices.map((device) => (device.kind === "robot" ? device.capacity : 1)));
  const both = step.kind === "pick_and_drop";
  const swap = () =>
    apply([
      { do: "set_param", id, name: "source", value: step.params.target },
      { do: "set_param", id, name: "target", value: step.params.source },
    ]);
  return (
    <>
      <PlaceField
        label={t(step.kind === "drop" ? "field.drop_at" : "field.pick_from")}
        field={both ? "source" : "at"}
        value={((both ? step.params.source : step.params.at) as Place) ?? null}
        accept={(device) => (step.kind === "drop" ? device.takes.length > 0 : device.gives.length > 0)}
        onChange={(place) => set(both ? "source" : "at", place)}
      />
      {both ? (
        <>
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
          <PlaceField
            label={t("field.drop_at")}
            field="target"
            value={(step.params.target as Place) ?? null}
            accept={(device) => device.takes.length > 0}
            onChange={(place) => set("target", place)}
          />
        </>
      ) : null}
      <div className={classes.pair}>
        <ValueField
          label={t("field.quantity")}
          field="quantity"
          value={step.params.quantity as Value}
          onChange={(value) => set("quantity", value)}
          minimum={1}
          maximum={most}
          placeholder={most > 1 ? t("field.up_to", { most }) : "1"}
        />
        <ValueField
          label={t("field.object")}
          field="object"
          type="text"
          value={step.params.object as Value}
          onChange={(value) => set("object", value)}
          options={objects}
          placeholder={t("field.choose")}
        />
      </div>
      <hr className={classes.line} />
      <RoleField />
      <RouteNote />
    </>
  );
}

/** "Move added for you: 18.4 m, about 1 min 6 s". */
export function RouteNote() {
  const { t, document, scene, surroundings, site, plan, compiled } = useOpenProgram();
  const { id } = useStepEditor();
  const way = waysOf(document, scene.tree, surroundings).find((each) => each.step === id);
  const route = way ? knownRoute(site.slug, plan?.version, way.key) : null;
  if (!way) return null;
  const length = route ? `${route.length_m.toFixed(1)}\u202fm` : "";
  if (drawnRoute(document.steps[id])) return <RouteChoice />;
  return (
    <>
      <RouteChoice />
      <div className={classes.added}>
        <VipoIcon name="move" size={16} />
        <strong>
          {t(
            compiled?.added_moves.includes(id) || document.steps[id]?.kind === "pick_and_drop"
              ? "move_added"
              : "field.route",
          )}
        </strong>
        <span>{route ? t("field.length", { length, time: durationText(route.seconds) }) : t("field.no_route")}</span>
      </div>
    </>
  );
}
