/** "Move added for you: 18.4 m, about 1 min 6 s". */
import { VipoIcon } from "@/design/VipoIcon";
import { knownRoute } from "../canvas/useRoutes";
import { RouteChoice } from "../gestures/RouteChoice";
import { drawnRoute } from "../model/drawnRoute";
import { waysOf } from "../scene/routing";
import { durationText } from "../scene/words";
import { useOpenProgram } from "../state/context";
import classes from "./inspector.module.css";
import { useStepEditor } from "./stepEditor";

export function RouteNote() {
  const { t, document, scene, surroundings, site, plan, compiled } = useOpenProgram();
  const { id } = useStepEditor();
  const way = waysOf(document, scene.tree, surroundings).find((each) => each.step === id);
  const route = way ? knownRoute(site.slug, plan?.version, way.key) : null;
  if (!way) return null;
  const length = route ? `${route.length_m.toFixed(1)}\u202fm` : "";
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
