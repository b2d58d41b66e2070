/** Whether the open program begins by itself when its event comes. */
import { ArmSwitch } from "@/shell/ArmSwitch";
import { useOpenProgram } from "../state/context";

export function Arm() {
  const { program, shared, site, document } = useOpenProgram();
  const starts = Object.values(document.steps).some(
    (step) => step.kind === "on_event" && step.params.starts === "run" && step.place,
  );
  return (
    <ArmSwitch
      site={site.slug}
      program={{ id: program.id, kinds: starts ? ["on_event"] : [] }}
      role={site.role}
      stored={() => shared.stored()}
    />
  );
}
