/** What floats over the map for a moment: a short word with Undo, and how to begin. */
import { Button } from "@mantine/core";
import { CircleCheck } from "lucide-react";
import { useEffect } from "react";
import { VipoIcon } from "@/design/VipoIcon";
import { useOpenProgram } from "../state/context";
import { RESTING, takeTool } from "../state/tool";
import { useUi } from "../state/ui";
import classes from "./float.module.css";

const TOAST_MS = 6000;

export function Toast() {
  const { t, shared } = useOpenProgram();
  const toast = useUi((ui) => ui.toast);
  useEffect(() => {
    if (!toast) return;
    const timer = setTimeout(() => useUi.setState({ toast: null }), TOAST_MS);
    return () => clearTimeout(timer);
  }, [toast]);
  if (!toast) return null;
  const undo = () => {
    shared.undo.undo();
    useUi.setState({ toast: null });
  };
  return (
    <div className={classes.toast} role="status">
      {toast.undo ? <CircleCheck size={16} aria-hidden="true" /> : null}
      {toast.text}
      {toast.undo ? (
        <button type="button" onClick={undo}>
          {t("undo")}
        </button>
      ) : null}
    </div>
  );
}

export function EmptyProgram() {
  const { t, document, canEdit } = useOpenProgram();
  const resting = useUi((ui) => ui.gesture.tool === "select");
  if (!canEdit || !resting || Object.keys(document.steps).length > 0) return null;
  return (
    <section className={classes.empty} aria-label={t("empty.title")}>
      <span className={classes.emptyIcon}>
        <VipoIcon name="pickdrop" size={22} />
      </span>
      <h2>{t("empty.title")}</h2>
      <p>{t("empty.text")}</p>
      <Button onClick={() => useUi.setState({ gesture: takeTool(RESTING, "pick_and_drop", false) })}>
        {t("empty.action")}
      </Button>
      <button type="button" className={classes.link} onClick={() => useUi.setState({ dialog: "library" })}>
        {t("empty.import")}
      </button>
    </section>
  );
}
