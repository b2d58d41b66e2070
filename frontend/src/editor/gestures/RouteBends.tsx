/** The bends of the selected step's route, to be dragged; whoever drags one has drawn the route. */
import { simplified } from "@/map/plane/paths";
import { toMetres } from "@/map/plane/projection";
import { drawnRoute } from "@/program/scene/stepPaths";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { CornerHandles } from "../canvas/CornerHandles";

export function RouteBends() {
  const { document, scene, canEdit, apply, t } = useOpenProgram();
  const selected = useUi((ui) => ui.selected);
  const resting = useUi((ui) => ui.gesture.tool === "select");
  const [id, second] = selected;
  const route = scene.routes.find((each) => each.step === id);
  const [first, last] = [route?.points[0], route?.points.at(-1)];
  if (!canEdit || !resting || id === undefined || second !== undefined || !route || !first || !last) return null;
  const bends = drawnRoute(document.steps[id]) ?? simplified(route.points).slice(1, -1).map(toMetres);
  return (
    <CornerHandles
      points={bends}
      closed={false}
      ends={[first, last]}
      fewest={0}
      nameOf={(number) => t("gesture.route.bend", { number })}
      nameOfNew={(number) => t("gesture.route.new_bend", { number })}
      onChange={(points) => apply([{ do: "set_param", id, name: "route", value: points.length > 0 ? points : null }])}
    />
  );
}
