/** "Move added for you: 18.4 m, about 1 min 6 s". */
import { SegmentedControl } from "@mantine/core";
import { useId } from "react";
import { VipoIcon } from "@/design/VipoIcon";
import { formatNumber, withUnit } from "@/i18n/format";
import { knownRoute } from "@/program/canvas/useRoutes";
import { drawnRoute, plannedBends, pathsOf } from "@/program/scene/stepPaths";
import { durationText } from "@/program/words/stepWords";
import { floorMark } from "@/map/floor/floor";
import { useOpenProgram } from "../../state/context";
import classes from "../../panel.module.css";
import { useStepEditor } from "./stepEditor";

export function RouteField() {
  const { t, document, scene, surroundings, site, plan, compiled } = useOpenProgram();
  const { id } = useStepEditor();
  const path = pathsOf(document, scene.tree, surroundings).find((each) => each.step === id);
  const route = path ? knownRoute(site.slug, floorMark(plan), path.key) : null;
  if (!path) return null;
  const length = route ? withUnit(formatNumber(route.length_m, 1), "m") : "";
  const added = compiled?.added_moves.includes(id) || document.steps[id]?.kind === "pick_and_drop";
  if (drawnRoute(document.steps[id])) return <RouteChoice />;
  return (
    <>
      <RouteChoice />
      <div className={classes.added}>
        <VipoIcon name="move" size={16} />
        <strong>{t(added ? "move_added" : "field.route")}</strong>
        <span>{route ? t("field.length", { length, time: durationText(route.seconds) }) : t("field.no_route")}</span>
      </div>
    </>
  );
}

export function RouteChoice() {
  const { t, scene } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const label = useId();
  const route = scene.routes.find((each) => each.step === id);
  const drawn = drawnRoute(step) !== null;
  if (!route) return null;
  return (
    <div className={classes.field}>
      <span className={classes.legend} id={label}>
        {t("gesture.route.label")}
      </span>
      <SegmentedControl
        fullWidth
        aria-labelledby={label}
        disabled={disabled}
        value={drawn ? "drawn" : "automatic"}
        onChange={(choice) => set("route", choice === "drawn" ? plannedBends(route.points) : null)}
        data={[
          { value: "automatic", label: t("gesture.route.automatic") },
          { value: "drawn", label: t("gesture.route.drawn") },
        ]}
      />
      {drawn ? <p className={classes.now}>{t("gesture.route.note")}</p> : null}
    </div>
  );
}
