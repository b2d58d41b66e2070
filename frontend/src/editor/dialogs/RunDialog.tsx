/** The open program is run, as it is drawn. */
import { RunDialog as RunProgram } from "@/shell/start/RunForm";
import { Arm } from "../parts/Arm";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { useStartable } from "./startable";

export function RunDialog() {
  const { diagnostics } = useOpenProgram();
  const about = useStartable();
  const opened = useUi((ui) => ui.dialog === "run");
  const errors = diagnostics.filter((each) => each.severity === "error").length;
  return (
    <RunProgram
      opened={opened}
      about={about}
      errors={errors}
      warnings={diagnostics.length - errors}
      onClose={() => useUi.setState({ dialog: null })}
    >
      <Arm />
    </RunProgram>
  );
}
