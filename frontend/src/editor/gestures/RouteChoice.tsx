/** In the inspector: the way as it is planned, or as somebody drew it. */
import { SegmentedControl } from "@mantine/core";
import { useId } from "react";
import { useStepEditor } from "../inspector/stepEditor";
import inspector from "../inspector/inspector.module.css";
import { drawnRoute } from "../model/drawnRoute";
import { useOpenProgram } from "../state/context";
import { plannedBends } from "./routes";

export function RouteChoice() {
  const { t, scene } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const label = useId();
  const route = scene.routes.find((each) => each.step === id);
  const drawn = drawnRoute(step) !== null;
  if (!route) return null;
  return (
    <div className={inspector.field}>
      <span className={inspector.legend} id={label}>
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
      {drawn ? <p className={inspector.now}>{t("gesture.route.note")}</p> : null}
    </div>
  );
}
