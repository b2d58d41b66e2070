/** Brings the program's own panel: back after it was closed, and as a sheet on small screens. */
import { Settings2 } from "lucide-react";
import { IconButton } from "@/design/IconButton";
import { useOpenProgram } from "../state/context";
import { hideProgram, PROGRAM_BUTTON, useUi } from "../state/ui";
import classes from "./float.module.css";

export function ProgramButton({ small, shown }: { small: boolean; shown: boolean }) {
  const { t } = useOpenProgram();
  const selected = useUi((ui) => ui.selected.length > 0);
  if (selected || (shown && !small)) return null;
  return (
    <div className={classes.programButton}>
      <IconButton
        id={PROGRAM_BUTTON}
        label={t("program.show")}
        aria-expanded={shown}
        onClick={() => (shown ? hideProgram() : useUi.setState({ inspector: true, programSheet: true }))}
      >
        <Settings2 size={17} aria-hidden="true" />
      </IconButton>
    </div>
  );
}
