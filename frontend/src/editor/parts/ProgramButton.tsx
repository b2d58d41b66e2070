/** Brings the program's own panel back after it was closed. */
import { Settings2 } from "lucide-react";
import { IconButton } from "@/design/IconButton";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import classes from "./float.module.css";

export function ProgramButton() {
  const { t } = useOpenProgram();
  const hidden = useUi((ui) => ui.inspector && ui.gesture.tool === "select");
  const selected = useUi((ui) => ui.selected.length > 0);
  if (hidden || selected) return null;
  return (
    <div className={classes.programButton}>
      <IconButton label={t("program.show")} onClick={() => useUi.setState({ inspector: true })}>
        <Settings2 size={17} aria-hidden="true" />
      </IconButton>
    </div>
  );
}
